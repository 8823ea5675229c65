/* input_file.h - reading of files that a user names, and of those that a scene names.
 *
 * Only regular files are read: a pipe would hang and a device never end. What a scene names lies beside it or below
 * (OutsideFiles).
 */
#pragma once

#include <string>
#include <vector>

#include <tandem/load_scene.h>

namespace tandem {

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
