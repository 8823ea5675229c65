/* input_file.cpp - reads regular files and records their names; see input_file.h. */
#include "host/io/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tandem/scene.h>

namespace tandem {
namespace {

namespace files = std::filesystem;

constexpr size_t most_bytes = size_t{4} << 30; /* the largest .glb */

thread_local FilesRead *watching = nullptr;

struct OpenFile {
  int descriptor;
  ~OpenFile()
  {
    if (descriptor >= 0) ::close(descriptor);
  }
};

[[noreturn]] void refuse(const std::string &path, const std::string &why)
{
  throw InputError(fmt::format("{}: cannot read: {}", path, why));
}

/* The reported size is only a hint: a file that grows meanwhile, or reports no size, is read to its end. */
std::string contents_of(const OpenFile &file, const std::string &path, size_t expected)
{
  std::string text(expected + 1, '\0');
  for (size_t size = 0;;) {
    const ssize_t got = ::read(file.descriptor, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path, std::strerror(errno));
    size += static_cast<size_t>(got);
    if (size > most_bytes) refuse(path, "it is larger than 4 GiB");
    if (got == 0) {
      text.resize(size);
      return text;
    }
    if (size == text.size()) text.resize(2 * size);
  }
}

bool is_below(const files::path &file, const files::path &folder)
{
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

/* The location of the file after links are resolved, as far as it can be determined. The name of a file that does not
 * exist is kept, but its folder is resolved. */
files::path place_of(const files::path &path)
{
  std::error_code error;
  const files::path whole = files::absolute(path.empty() ? "." : path, error);
  const files::path place = error ? files::path() : files::weakly_canonical(whole, error);
  if (error) refuse(path.string(), error.message());
  return place;
}

} // namespace

FilesRead::FilesRead() { watching = this; }
FilesRead::~FilesRead() { watching = nullptr; }

/* The file is opened without blocking, because a pipe opens only when somebody writes to it. */
std::string read_file(const std::string &path)
{
  const OpenFile file{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat status {};
  if (file.descriptor < 0 || ::fstat(file.descriptor, &status) != 0) refuse(path, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse(path, std::strerror(EISDIR));
  if (!S_ISREG(status.st_mode)) refuse(path, "it is a pipe, a device or a socket; a regular file is needed");
  if (static_cast<size_t>(status.st_size) > most_bytes) refuse(path, "it is larger than 4 GiB");
  if (watching) watching->paths.push_back(path);
  return contents_of(file, path, static_cast<size_t>(status.st_size));
}

std::string read_file_beside(const std::string &scene, const std::string &name, OutsideFiles outside,
                             const std::string &asks)
{
  if (name.empty() || name.find('\0') != std::string::npos)
    throw InputError(fmt::format("{}: \"{}\" is no name of a file", asks, name.c_str()));
  const files::path folder = files::path(scene).parent_path(), file = folder / name;
  try {
    if (outside == OutsideFiles::refused && !is_below(place_of(file), place_of(folder)))
      throw InputError(fmt::format("\"{}\" lies outside the folder of the scene; put the file there, or use "
                                   "--allow-outside-files for a scene that you trust",
                                   name));
    return read_file(file.string());
  } catch (const InputError &reason) {
    throw InputError(fmt::format("{}: {}", asks, reason.what()));
  }
}

bool lacks_file_beside(const std::string &scene, const std::string &name)
{
  if (name.empty() || name.find('\0') != std::string::npos) return false;
  const files::path folder = files::path(scene).parent_path(), place = place_of(folder / name);
  std::error_code error;
  return is_below(place, place_of(folder)) && !files::exists(place, error) && !error;
}

} // namespace tandem
