/* input_file.h - reads files that a user names, and files that a scene names.
 *
 * Only regular files are read, because a pipe could block and a device may have no end. Files that a scene names must
 * lie in its folder or below it (OutsideFiles).
 */
#pragma once

#include <string>
#include <vector>

#include <tandem/load_scene.h>

namespace tandem {

/* Records the names of the files that this thread reads during its lifetime, so that no output replaces them. Only one
 * may exist per thread. */
class FilesRead {
public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead &) = delete;
  FilesRead &operator=(const FilesRead &) = delete;

  std::vector<std::string> paths;
};

/* Reads the whole file. Throws InputError if it cannot be read, is no regular file, or is larger than 4 GiB. */
std::string read_file(const std::string &path);

/* Reads the file `name`, relative to the folder of the file `scene`. Throws InputError as read_file does, and for a
 * location outside that folder; `asks` begins the message. */
std::string read_file_beside(const std::string &scene, const std::string &name, OutsideFiles outside,
                             const std::string &asks);

/* True if that file would lie in the folder of the scene and does not exist. */
bool lacks_file_beside(const std::string &scene, const std::string &name);

} // namespace tandem
