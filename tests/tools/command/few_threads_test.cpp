/* few_threads_test.cpp - if threads cannot be started, a run continues with those that can, gives the same bits, and
 * reports it. */
#include <functional>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "minicl/worker_threads.h"
#include "tests/catch.h"

#if defined(TANDEM_COMMAND) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string run_wide = "run box-grid:nx=20,ny=20,nz=20 --steps 1 --substeps 1 --on tbb:threads=16";

std::string hash_in(const std::string &text)
{
  const size_t at = text.find("hash ");
  return at == std::string::npos ? "no hash" : text.substr(at);
}

/* With all the bits, or an end in one line. */
void check_ending(const Result &result, const std::string &hash)
{
  CAPTURE(result.out, result.error);
  REQUIRE((result.status == 0 || result.status == 1));
  if (result.status == 0) CHECK(hash_in(result.out) == hash);
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') <= 1);
  if (!result.error.empty()) CHECK(result.error.find("tandem: ") == 0);
}

/* Runs in a child within a limit; what it returns, below 255. */
int within(__rlimit_resource resource, rlim_t limit, const std::function<int()> &work)
{
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limits{limit, limit};
    if (resource == RLIMIT_NPROC && (::setgid(61234) != 0 || ::setuid(61234) != 0)) _exit(255);
    if (::setrlimit(resource, &limits) != 0) _exit(255);
    _exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

constexpr size_t stack = size_t{4} << 20;

} // namespace

TEST_CASE("few threads: a run under a limit of addresses goes on with those that start, has the same bits and says so",
          "[command]")
{
  const std::string hash = hash_in(command(run_wide).out);
  bool fewer = false;
  for (const char *kilobytes :
       {"150000", "200000", "250000", "300000", "350000", "500000", "700000", "1000000", "1500000"}) {
    const Result result = command(run_wide, std::string("ulimit -v ") + kilobytes + ";");
    CAPTURE(kilobytes);
    check_ending(result, hash);
    if (result.status == 1) CHECK(result.error.find("out of memory") != std::string::npos);
    fewer = fewer || (result.status == 0 && result.error.find("of 16 threads could be started") != std::string::npos);
  }
  CHECK(fewer);
  CHECK(command(run_wide).error.empty());
}

TEST_CASE("few threads: the direct solver, whose islands are spread over threads, goes on with those that start",
          "[command]")
{
  const std::string solve = "run box-grid:nx=5,ny=2,nz=5 --steps 1 --solver direct --on tbb:threads=16";
  const std::string hash = hash_in(command(solve).out);
  int whole = 0, fewer = 0;
  for (const char *kilobytes : {"150000", "200000", "300000", "500000"}) {
    const Result result = command(solve, std::string("ulimit -v ") + kilobytes + ";");
    check_ending(result, hash);
    whole += result.status == 0;
    fewer += result.status == 0 && result.error.find("of 16 threads could be started") != std::string::npos;
  }
  CHECK(whole > 0);
  CHECK(fewer > 0);
}

TEST_CASE("few threads: cases side by side take as many as start", "[command]")
{
  const Scratch scratch;
  for (const char *kilobytes : {"200000", "300000", "500000"}) {
    const Result result = command("stability --cases-in-parallel 64 --quick --solvers soft-step --only "
                                  "miss-ball-edge,miss-ball-corner,miss-box-edge --out " +
                                      scratch.file("out"),
                                  std::string("ulimit -v ") + kilobytes + ";");
    CAPTURE(kilobytes, result.out, result.error);
    CHECK((result.status == 0 || result.error.find("out of memory") != std::string::npos));
    CHECK(std::count(result.error.begin(), result.error.end(), '\n') <= 1);
  }
}

#ifdef TANDEM_FAILING_THREADS
/* The case in which another process takes the memory for a thread before TBB starts the thread. */
TEST_CASE("few threads: whichever thread fails to start, the command ends by itself, in one line", "[command]")
{
  const std::string hash = hash_in(command(run_wide).out);
  int refused = 0;
  for (int granted = 0; granted < 40; granted += granted < 15 ? 5 : 1) {
    const Result result =
        command(run_wide, "LD_PRELOAD=" TANDEM_FAILING_THREADS " THREADS_THAT_START=" + std::to_string(granted));
    CAPTURE(granted);
    check_ending(result, hash);
    if (result.status == 1) CHECK(result.error.find("pthread_create has failed") != std::string::npos);
    refused += result.status == 1;
  }
  CHECK(refused > 0);
}
#endif

TEST_CASE("few threads: as many as are wanted, where nothing is short")
{
  CHECK(tandem::minicl::startable_threads(0, stack) == 0);
  CHECK(tandem::minicl::startable_threads(7, stack) == 7);
}

TEST_CASE("few threads: those that a limit of addresses leaves room for")
{
  const int few = within(RLIMIT_AS, rlim_t{2} << 30,
                         [] { return static_cast<int>(tandem::minicl::startable_threads(100, stack)); });
  CHECK(few > 3);
  CHECK(few < 16);
  CHECK(within(RLIMIT_AS, rlim_t{1} << 20,
               [] { return static_cast<int>(tandem::minicl::startable_threads(100, stack)); }) == 0);
}

TEST_CASE("few threads: one less than a limit of processes leaves, as another may take it")
{
  if (::geteuid() != 0) tests::skip("only root can be a user without other processes");
  CHECK(within(RLIMIT_NPROC, 10, [] { return static_cast<int>(tandem::minicl::startable_threads(100, stack)); }) == 8);
  CHECK(within(RLIMIT_NPROC, 10, [] { return static_cast<int>(tandem::minicl::startable_threads(5, stack)); }) == 5);
  CHECK(within(RLIMIT_NPROC, 1, [] { return static_cast<int>(tandem::minicl::startable_threads(5, stack)); }) == 0);
}
#endif
