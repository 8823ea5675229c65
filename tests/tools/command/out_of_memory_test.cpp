/* The real program under a memory limit: one line that names the operation, exit status 1, and never a crash. */
#if defined(TANDEM_COMMAND) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include <algorithm>
#include <regex>
#include <string>

#include "host/base/out_of_memory.h"
#include "host/runtime/interface/faults.h"
#include "tests/tools/command/command_line.h"
#include "tools/stability/cases.h"

using command_line::Result;

namespace {

/* kilobytes: of address space. One arena, so that threads do not take theirs ahead of use. */
Result run_within(uint64_t kilobytes, const std::string &arguments)
{
  return command_line::command(arguments, "ulimit -v " + std::to_string(kilobytes) + "; MALLOC_ARENA_MAX=1");
}

void check_one_line(const Result &result)
{
  CHECK(result.out.empty());
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
  CHECK(result.error.find("tandem: ") == 0);
}

} // namespace

/* The limits go from one that the loader alone exceeds to one that suffices. */
TEST_CASE("a run that memory does not suffice for says in one line what was wanted")
{
  int refused = 0;
  bool done = false;
  for (uint64_t kilobytes = 30'000; kilobytes < 4'000'000 && !done; kilobytes += 10'000) {
    const Result result = run_within(kilobytes, "run box-grid:nx=30,ny=30,nz=30 --steps 1 --substeps 1 --on serial");
    CAPTURE(kilobytes, result.out, result.error);
    if (result.status == 127) continue; /* not even the loader */
    done = result.status == 0;
    if (done) break;
    ++refused;
    CHECK(result.status == 1);
    check_one_line(result);
    CHECK(result.error.find("out of memory") != std::string::npos);
    CHECK(std::regex_search(result.error, std::regex("[0-9]+ bytes")));
    CHECK(std::regex_search(result.error, std::regex("box-grid|27001 bodies")));
  }
  CHECK(done);
  CHECK(refused > 3);
}

TEST_CASE("a limit of pairs ends a run with one line that names it, and help tells of it")
{
  const Result result = run_within(4'000'000, "run box-grid:nx=5,ny=5,nz=5 --steps 3 --on serial --max-pairs 200");
  INFO(result.error);
  CHECK(result.status == 1);
  check_one_line(result);
  CHECK(result.error.find("200 are the most (--max-pairs, Settings::max_pairs)") != std::string::npos);
  CHECK(run_within(4'000'000, "run --help").out.find("--max-pairs") != std::string::npos);
  for (const char *help : {"--help", "run --help", "diff --help", "stability --help"}) {
    const std::string text = run_within(4'000'000, help).out;
    CAPTURE(help, text);
    CHECK(text.find("did not suffice") != std::string::npos);
    CHECK(text.find("memory") != std::string::npos);
  }
  CHECK(run_within(4'000'000, "run rolling --max-pairs 268435457").status == 2);
}

/* A case that memory does not suffice for shows nothing of its solver. */
TEST_CASE("a case that memory does not suffice for is no failed case")
{
  using namespace tandem;
  const std::vector<stability::Case> cases = stability::all_cases();
  faults::hook = [](faults::Site site) { return site == faults::Site::allocation; };
  bool told = false;
  try {
    stability::run_case(cases.front(), stability::Length::brief, "soft-step", {"serial", {}, false}, {});
  } catch (const OutOfMemory &) {
    told = true;
  } catch (const std::bad_alloc &) {
    told = true;
  }
  faults::hook = nullptr;
  CHECK(told);
}

#endif
