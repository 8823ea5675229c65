/* probe.cpp - forks a child that queries the drivers, and waits for its answer on a pipe; see probe.h. */
#include "host/runtime/opencl/probe.h"

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <fmt/format.h>

namespace tandem::opencl {
namespace {

constexpr char came_back = 'y';                           /* first byte of the child's answer */
constexpr int usual_timeout = 60, longest_timeout = 3600; /* s; each of several sleeping GPUs takes seconds to wake */

int timeout_seconds()
{
  const char *given = std::getenv("TANDEM_OPENCL_TIMEOUT");
  const int seconds = given ? std::atoi(given) : 0;
  return seconds > 0 && seconds <= longest_timeout ? seconds : usual_timeout;
}

/* Messages and core dumps of a crashing driver are of no use to the user of the parent process. */
void make_quiet()
{
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGHUP})
    std::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, output);
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

[[noreturn]] void be_child(int answer, const std::function<void()> &ask)
{
  make_quiet();
  try {
    ask();
  } catch (const DriverFault &fault) {
    const std::string said = came_back + std::string(fault.what()).substr(0, PIPE_BUF - 1);
    _exit(::write(answer, said.data(), said.size()) > 0 ? 0 : 1);
  } catch (...) { /* the parent will get the same exception and report it */
  }
  _exit(::write(answer, &came_back, 1) == 1 ? 0 : 1);
}

struct Answer {
  enum End { came_back, died, hangs } end;
  std::string said;
};

/* If the child dies, its end of the pipe is closed. */
Answer wait_for(int answer)
{
  pollfd waiting{answer, POLLIN, 0};
  int ready = 0;
  do ready = ::poll(&waiting, 1, 1000 * timeout_seconds());
  while (ready < 0 && errno == EINTR);
  if (ready == 0) return {Answer::hangs, {}};
  char text[PIPE_BUF];
  const ssize_t size = ::read(answer, text, sizeof text);
  if (size < 1) return {Answer::died, {}};
  return {Answer::came_back, std::string(text + 1, static_cast<size_t>(size - 1))};
}

std::string end_of(int status)
{
  if (WIFSIGNALED(status)) return fmt::format("crashed ({})", strsignal(WTERMSIG(status)));
  return fmt::format("ended the process (status {})", WEXITSTATUS(status));
}

std::string not_asked(const char *what, int reason)
{
  return fmt::format("the OpenCL drivers cannot be asked for their devices: {}: {}", what, std::strerror(reason));
}

} // namespace

std::string driver_fault(const std::function<void()> &ask)
{
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return not_asked("no pipe", errno);
  const pid_t child = ::fork();
  const int reason = errno;
  if (child == 0) be_child(ends[1], ask);
  ::close(ends[1]);
  const Answer answer = child < 0 ? Answer{Answer::died, {}} : wait_for(ends[0]);
  ::close(ends[0]);
  if (child < 0) return not_asked("no process of their own", reason);
  if (answer.end == Answer::hangs) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  if (answer.end == Answer::came_back) return answer.said;
  const std::string advice = "OCL_ICD_VENDORS=FOLDER chooses the drivers that are loaded, and tbb and serial need none";
  if (answer.end == Answer::died)
    return fmt::format("an OpenCL driver {} while it was asked for its devices; {}", end_of(status), advice);
  return fmt::format("an OpenCL driver gave no answer in {} s while it was asked for its devices; "
                     "TANDEM_OPENCL_TIMEOUT=SECONDS waits longer; {}",
                     timeout_seconds(), advice);
}

} // namespace tandem::opencl
