/* child.cpp - forks, and reads the answer as JSON from a pipe; see child.h. */
#include "tools/command/child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tandem/error.h>

namespace tandem {
namespace {

Json answer_to(const std::function<Json()> &work)
{
  try {
    return {{"answer", work()}};
  } catch (const InputError &error) {
    return {{"input", error.what()}};
  } catch (const std::exception &error) {
    return {{"error", error.what()}};
  }
}

/* The exit is that of a process, because drivers write their caches in its course. */
[[noreturn]] void be_child(int answer, const std::function<Json()> &work)
{
  const std::string text = answer_to(work).dump();
  size_t written = 0;
  while (written < text.size()) {
    const ssize_t size = ::write(answer, text.data() + written, text.size() - written);
    if (size < 0 && errno != EINTR) break;
    if (size > 0) written += static_cast<size_t>(size);
  }
  ::close(answer);
  std::exit(0);
}

std::string text_from(int pipe)
{
  std::string text;
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t size = ::read(pipe, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return text;
    text.append(part.data(), static_cast<size_t>(size));
  }
}

[[noreturn]] void fail(const char *what)
{
  throw std::runtime_error(fmt::format("no process of its own for a measurement: {}: {}", what, std::strerror(errno)));
}

void check_end(pid_t child, const std::string &text)
{
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  if (WIFSIGNALED(status))
    throw std::runtime_error(
        fmt::format("a process that measured ended by a signal ({})", strsignal(WTERMSIG(status))));
  if (text.empty()) throw std::runtime_error("a process that measured ended without an answer");
}

} // namespace

Json answer_of_child(const std::function<Json()> &work)
{
  std::array<int, 2> ends;
  std::fflush(stdout); /* the child would print it once more */
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    be_child(ends[1], work);
  }
  ::close(ends[1]);
  const std::string text = child < 0 ? "" : text_from(ends[0]);
  ::close(ends[0]);
  if (child < 0) fail("fork");
  check_end(child, text);
  const Json json = Json::parse(text);
  if (json.contains("input")) throw InputError(json["input"].get<std::string>());
  if (json.contains("error")) throw std::runtime_error(json["error"].get<std::string>());
  return json["answer"];
}

} // namespace tandem
