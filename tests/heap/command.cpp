/* command.cpp - lets every allocation of the command fail in turn, from its first line on. The command must end by
 * itself, with one line and exit status 1.
 *
 * Each attempt runs in a child process that has done nothing yet, so that what is made once is made there. TBB's
 * threads do not exist in a child, so these tests come before all tests that start some. */
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/heap/attempt.h"
#include "tests/tools/command/command_line.h"
#include "tools/command/failed_allocation.h"

int command_main(int count, char **arguments); /* tools/command/main.cpp, whose main() is renamed for this program */

namespace tandem {
/* tools/command/failed_allocation.cpp has operators of its own. */
std::string failed_allocation() { return {}; }
size_t failed_allocation_bytes() { return 0; }
} // namespace tandem

using namespace tests::heap;
using command_line::Scratch;

namespace {

constexpr int not_struck = 100; /* added to the exit status */

struct Ending {
  bool struck = false, by_itself = false;
  int status = 0;
  std::string error;
};

/* Nothing above it catches what main() lets go. */
[[noreturn]] void be_command(std::vector<std::string> words, int error, uint64_t nth, bool once) noexcept
{
  std::vector<char *> arguments;
  for (std::string &word : words) arguments.push_back(word.data());
  ::dup2(error, STDERR_FILENO);
  std::FILE *nowhere = std::freopen("/dev/null", "w", stdout);
  int status = 0;
  {
    const Failing failing(nth, once);
    status = command_main(static_cast<int>(arguments.size()), arguments.data());
  }
  _exit(nowhere ? status + (struck() ? 0 : not_struck) : 99);
}

Ending run(const std::vector<std::string> &words, uint64_t nth, bool once)
{
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) be_command(words, ends[1], nth, once);
  ::close(ends[1]);
  Ending ending;
  char buffer[4096];
  for (ssize_t size; (size = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    ending.error.append(buffer, static_cast<size_t>(size));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  ending.by_itself = WIFEXITED(status);
  ending.struck = !ending.by_itself || WEXITSTATUS(status) < not_struck;
  ending.status = ending.by_itself ? WEXITSTATUS(status) % not_struck : WTERMSIG(status);
  return ending;
}

/* Nothing, where it could do without, or one line. */
void check_ending(const Ending &ending)
{
  INFO(ending.error);
  REQUIRE(ending.by_itself);
  if (ending.status == 0) {
    CHECK(ending.error.empty());
    return;
  }
  CHECK(ending.status == 1);
  CHECK(std::count(ending.error.begin(), ending.error.end(), '\n') == 1);
  CHECK(ending.error.find("tandem: ") == 0);
  CHECK(ending.error.find("out of memory") != std::string::npos);
}

void fail_everywhere_in_command(
    const std::vector<std::string> &words, uint64_t stride,
    const std::function<void(const Ending &)> &after = [](const Ending &) {})
{
  uint64_t failures = 0;
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += (once ? stride : 7 * stride) * tests::share_of_faults(5)) {
      CAPTURE(words, nth, once);
      const Ending ending = run(words, nth, once);
      check_ending(ending);
      after(ending);
      failures += ending.status != 0;
      if (!ending.struck) break;
    }
  CHECK(failures > 0);
}

} // namespace

TEST_CASE("heap: a command that runs out of memory wherever it allocates ends with one line and status 1")
{
  fail_everywhere_in_command(
      {"tandem", "run", "box-grid:nx=2,ny=2,nz=2", "--steps", "1", "--substeps", "1", "--on", "serial"}, 1);
}

/* Each is whole or not there, and none waits beside for its end. */
TEST_CASE("heap: a command that runs out of memory leaves no file unfinished")
{
  const Scratch folder;
  const std::set<std::string> names = {"out.json", "events.json", "motion.glb"};
  const auto check_files = [&](const Ending &ending) {
    size_t count = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder.path)) {
      CHECK(names.count(entry.path().filename().string()) == 1);
      CHECK(entry.file_size() > 200);
      std::filesystem::remove(entry.path());
      ++count;
    }
    if (ending.status == 0) CHECK(count == names.size());
  };
  fail_everywhere_in_command({"tandem", "run", TANDEM_SOURCE_DIR "/tests/scenes/three_bodies.json", "--steps", "1",
                              "--substeps", "1", "--on", "serial", "--json", folder.file("out.json"), "--events",
                              folder.file("events.json"), "--save", folder.file("motion.glb")},
                             3, check_files);
}
