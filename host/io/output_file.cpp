/* output_file.cpp - writes to a temporary file beside the target and renames it; see output_file.h. */
#include "host/io/output_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
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

constexpr size_t most_buffered = 1 << 16;
constexpr int most_links = 40, most_names = 1000;

/* A link is kept, and the file that it points to is replaced. */
std::string behind_links(std::string path)
{
  std::error_code error;
  for (int k = 0; k < most_links && files::is_symlink(path, error); ++k)
    path = (files::path(path).parent_path() / files::read_symlink(path, error)).string();
  return path;
}

/* Creates a file with an unused name. Returns -1 and errno if the folder accepts none. */
int make_beside(const std::string &target, std::string &name)
{
  static std::atomic<unsigned> counter{0};
  for (int k = 0; k < most_names; ++k) {
    name = fmt::format("{}.unfinished-{}-{}", target, ::getpid(), counter++);
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

/* The names of unfinished files, at fixed addresses, so that a signal handler can read them whatever it interrupted. */
struct Unfinished {
  enum State { none, being_named, named };
  std::atomic<int> state{none};
  std::array<char, PATH_MAX> name{};
};
std::array<Unfinished, 32> unfinished;

/* The index of the remembered name, for forget(); -1 if all are in use. */
int remember(const std::string &name)
{
  for (size_t k = 0; k < unfinished.size() && name.size() < PATH_MAX; ++k) {
    int expected = Unfinished::none;
    if (!unfinished[k].state.compare_exchange_strong(expected, Unfinished::being_named)) continue;
    std::memcpy(unfinished[k].name.data(), name.c_str(), name.size() + 1);
    unfinished[k].state = Unfinished::named;
    return static_cast<int>(k);
  }
  return -1;
}

void forget(int place)
{
  if (place >= 0) unfinished[static_cast<size_t>(place)].state = Unfinished::none;
}

int nameless()
{
  const File file(std::tmpfile());
  return file ? ::fcntl(::fileno(file.get()), F_DUPFD_CLOEXEC, 3) : -1;
}

} // namespace

/* Delegates to the other constructor, so that the destructor cleans up if this one fails. */
OutputFile::OutputFile(const std::string &path, std::string label) : OutputFile(std::move(label))
{
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(errno);
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  direct_ = exists && !S_ISREG(status.st_mode);
  if (direct_) { /* opened without waiting for a reader, then set to wait */
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    ::fcntl(descriptor_, F_SETFL, O_WRONLY);
    return;
  }
  if (exists && ::access(path.c_str(), W_OK) != 0) fail(errno);
  open_beside(path);
  if (exists && !beside_.empty() && ::fchmod(descriptor_, status.st_mode & 07777) != 0) fail(errno);
}

/* A folder that accepts no new file may still contain a file that can be written. */
void OutputFile::open_beside(const std::string &path)
{
  target_ = behind_links(path);
  descriptor_ = make_beside(target_, beside_);
  if (descriptor_ >= 0) remembered_ = remember(beside_);
  if (descriptor_ >= 0) return;
  const int reason = errno;
  beside_.clear();
  if (::access(target_.c_str(), W_OK) != 0) fail(reason);
  descriptor_ = nameless();
  if (descriptor_ < 0) fail(errno);
}

OutputFile::~OutputFile()
{
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!beside_.empty()) ::unlink(beside_.c_str());
  forget(remembered_);
}

/* The temporary file has become the target. */
void OutputFile::forget_beside()
{
  forget(std::exchange(remembered_, -1));
  beside_.clear();
}

void OutputFile::fail(int error) const
{
  throw InputError(fmt::format("{}: cannot write: {}", label_, std::strerror(error)));
}

void OutputFile::write(std::string_view bytes)
{
  buffer_ += bytes;
  if (buffer_.size() > most_buffered) flush();
}

void OutputFile::flush()
{
  put(descriptor_, buffer_);
  buffer_.clear();
}

void OutputFile::put(int descriptor, std::string_view bytes) const
{
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

void OutputFile::commit()
{
  flush();
  const bool named = !beside_.empty();
  if (!direct_ && (!named || ::rename(beside_.c_str(), target_.c_str()) != 0)) copy_to_target();
  else forget_beside();
  close();
}

/* Used if the target cannot be replaced, such as a file that is a mount point. It is truncated only when all contents
 * are ready. */
void OutputFile::copy_to_target()
{
  std::string piece(most_buffered, '\0');
  if (::lseek(descriptor_, 0, SEEK_SET) != 0) fail(errno);
  OutputFile target(label_);
  target.descriptor_ = ::open(target_.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (target.descriptor_ < 0) fail(errno);
  for (ssize_t got = 0; (got = ::read(descriptor_, piece.data(), piece.size())) > 0;)
    put(target.descriptor_, {piece.data(), static_cast<size_t>(got)});
  target.close();
}

void OutputFile::close()
{
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
}

void OutputFile::check(const std::string &path, const std::string &label)
{
  struct stat status {};
  const bool direct = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
  if (direct && ::access(path.c_str(), W_OK) != 0)
    throw InputError(fmt::format("{}: cannot write: {}", label, std::strerror(errno)));
  if (!direct) OutputFile(path, label);
}

void remove_unfinished_files() noexcept
{
  for (const Unfinished &file : unfinished)
    if (file.state == Unfinished::named) ::unlink(file.name.data());
}

bool is_same_file(const std::string &one, const std::string &other)
{
  struct stat first {
  }, second{};
  const bool exists = ::stat(one.c_str(), &first) == 0;
  if (exists != (::stat(other.c_str(), &second) == 0)) return false;
  if (exists) return !S_ISCHR(first.st_mode) && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
  std::error_code error;
  const auto place = [&](const std::string &path) {
    return files::weakly_canonical(files::absolute(behind_links(path), error), error);
  };
  return place(one) == place(other) && !error;
}

File nameless_file_beside(const std::string &path)
{
  std::string name;
  struct stat status {};
  const bool direct = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
  const int descriptor = direct ? -1 : make_beside(behind_links(path), name);
  if (descriptor < 0) return File(std::tmpfile());
  ::unlink(name.c_str());
  File file(::fdopen(descriptor, "w+b"));
  const int reason = errno;
  if (!file) ::close(descriptor);
  errno = reason;
  return file;
}

} // namespace tandem
