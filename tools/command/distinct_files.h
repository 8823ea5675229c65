/* distinct_files.h - ensures that no output of a command replaces another output, or a file that the command reads.
 *
 * A command registers each file that it reads or writes before anything runs; a second use of a file is refused.
 */
#pragma once

#include <string>
#include <vector>

namespace tandem {

class DistinctFiles {
public:
  /* Throws InputError if the file is an output. `name` begins the message, for example "--problems". */
  void reads(const std::string &name, const std::string &path);
  /* Throws InputError if the file has another use or cannot be written. An empty path stands for no file. */
  void writes(const std::string &option, const std::string &path);

private:
  struct Use {
    std::string name, path;
  };
  std::vector<Use> read_, written_;
};

} // namespace tandem
