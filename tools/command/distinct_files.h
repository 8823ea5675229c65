/* distinct_files.h - no output of a command may take the place of another one, or of what the command reads.
 *
 * Each file that is read or written is told here before anything runs; the second use of one is refused.
 */
#pragma once

#include <string>
#include <vector>

namespace tandem {

class DistinctFiles {
public:
  /* InputError where an output has this place. `name` begins the message, as in "--problems". */
  void reads(const std::string &name, const std::string &path);
  /* InputError where another use has this place, or where the file cannot be written. An empty path is none. */
  void writes(const std::string &option, const std::string &path);

private:
  struct Use {
    std::string name, path;
  };
  std::vector<Use> read_, written_;
};

} // namespace tandem
