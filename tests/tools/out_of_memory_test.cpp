/* The real program under a limit of memory: one line that says what was wanted, exit status 1, and never a crash. */
#if defined(TANDEM_COMMAND) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include "tests/catch.h"

#include <algorithm>
#include <cstdio>
#include <regex>
#include <string>
#include <sys/wait.h>

namespace {

struct Result {
  int status;
  std::string text; /* both streams */
};

/* kilobytes: of address space. One arena, so that threads do not take theirs ahead of use. */
Result run_within(uint64_t kilobytes, const std::string &arguments)
{
  const std::string command = "ulimit -v " + std::to_string(kilobytes) + "; MALLOC_ARENA_MAX=1 '" TANDEM_COMMAND "' " + arguments + " 2>&1";
  std::FILE *pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string text;
  char buffer[4096];
  for (size_t size; (size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, size);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

} // namespace

/* From what the loader alone does not fit in to what suffices. */
TEST_CASE("a run that memory does not suffice for says in one line what was wanted")
{
  int refused = 0;
  bool done = false;
  for (uint64_t kilobytes = 30'000; kilobytes < 4'000'000 && !done; kilobytes += 10'000) {
    const Result result = run_within(kilobytes, "run box-grid:nx=30,ny=30,nz=30 --steps 1 --substeps 1 --on serial");
    CAPTURE(kilobytes, result.text);
    if (result.status == 127) continue; /* not even the loader */
    done = result.status == 0;
    if (done) break;
    ++refused;
    CHECK(result.status == 1);
    CHECK(std::count(result.text.begin(), result.text.end(), '\n') == 1);
    CHECK(result.text.find("tandem: ") == 0);
    CHECK(result.text.find("out of memory") != std::string::npos);
    CHECK(std::regex_search(result.text, std::regex("[0-9]+ bytes")));
    CHECK(std::regex_search(result.text, std::regex("box-grid|27001 bodies")));
  }
  CHECK(done);
  CHECK(refused > 3);
}

TEST_CASE("a limit of pairs ends a run with one line that names it, and help tells of it")
{
  const Result result = run_within(4'000'000, "run box-grid:nx=5,ny=5,nz=5 --steps 3 --on serial --max-pairs 200");
  INFO(result.text);
  CHECK(result.status == 1);
  CHECK(std::count(result.text.begin(), result.text.end(), '\n') == 1);
  CHECK(result.text.find("200 are the most (--max-pairs, Settings::max_pairs)") != std::string::npos);
  CHECK(run_within(4'000'000, "run --help").text.find("--max-pairs") != std::string::npos);
  CHECK(run_within(4'000'000, "run rolling --max-pairs 268435457").status == 2);
}

#endif
