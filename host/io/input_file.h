/* input_file.h - reading of files that a user names, and of those that a scene names.
 *
 * A scene may come from anywhere, so what it names (a buffer of a glTF file, an OBJ file) lies in its own folder or
 * below it, wherever links and `..` lead; who trusts a scene says so. Only regular files are read: a pipe would hang
 * and a device never end.
 */
#pragma once

#include <string>
#include <vector>

namespace tandem {

enum class OutsideFiles { refused, allowed };

/* The names of the files that this thread reads while it lives, so that no output takes their place. One at a time. */
class FilesRead {
public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead &) = delete;
  FilesRead &operator=(const FilesRead &) = delete;

  std::vector<std::string> paths;
};

/* The whole file. InputError where it cannot be read, is no regular file, or is larger than 4 GiB. */
std::string read_file(const std::string &path);

/* `name`, relative to the folder of the file `scene`. InputError as above and for a place outside that folder; `asks`
 * begins the message. */
std::string read_file_beside(const std::string &scene, const std::string &name, OutsideFiles outside,
                             const std::string &asks);

} // namespace tandem
