/* main.cpp - the command `tandem`: parses arguments, runs one subcommand, and turns errors into one line. */
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tandem/scene.h>
#include <tandem/version.h>

#include "host/base/out_of_memory.h"
#include "host/base/printable.h"
#include "host/io/output_file.h"
#include "minicl/worker_threads.h"
#include "tools/command/command.h"
#include "tools/command/failed_allocation.h"

namespace tandem {
namespace {

/* One thread prints the error: the command, which has told a status then, or one that fails. */
std::atomic_flag line_is_taken = ATOMIC_FLAG_INIT;
thread_local bool line_is_mine = false;
std::atomic<int> told_status = 0;

/* Scripts read one line for each error, so line ends in a library's message are replaced. */
int complain(std::string message, int status)
{
  while (!line_is_mine && line_is_taken.test_and_set()) ::pause(); /* a thread is printing and will end the process */
  line_is_mine = true;
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  std::fputs(fmt::format("tandem: {}\n", printable(message)).c_str(), stderr);
  if (status > 0) told_status = status;
  else line_is_mine = false, line_is_taken.clear();
  return status;
}

void end_as_asked(int signal)
{
  remove_unfinished_files();
  ::raise(signal); /* ends the process now, with a status that its parent recognises */
}

/* Signals that the process was started to ignore, as by nohup, stay ignored. */
void clean_up_when_asked_to_end()
{
  struct sigaction action {
  }, before{};
  action.sa_handler = end_as_asked;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      ::sigaction(signal, &action, nullptr);
}

/* A file that is opened later would otherwise get the number of a closed standard stream, and printed text would be
 * written to it. */
void keep_standard_files_apart()
{
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(file, F_GETFD) == -1)
      open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY); /* so that any use of it fails */
}

constexpr int output_lost = -1; /* the error has been printed */

/* If the reader of standard output has exited, as `head` does, the process ends by SIGPIPE as other commands do; errors
 * of other pipes are reported like those of files. */
int complain_of_output(int reason)
{
  if (reason == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  complain(fmt::format("standard output: cannot write: {}", std::strerror(reason ? reason : EIO)), 2);
  return output_lost;
}

/* Printed text may still be in the buffer. If status 2 has been reported, its line is the only one. */
int with_output_written(int status)
{
  errno = 0;
  if (status != output_lost && status != 2 && (std::fflush(stdout) != 0 || std::ferror(stdout)))
    status = complain_of_output(errno);
  return status == output_lost ? 2 : status;
}

std::string typed(int count, char **arguments)
{
  std::string text = "tandem";
  for (int k = 1; k < count; ++k) text += fmt::format(" {}", arguments[k]);
  return text;
}

/* Exceptions that nothing catches: the destructor of nlohmann's JSON allocates, reporting the first failure may fail
 * too, and a library's thread throws if it cannot start another. The text of the message is prepared in advance. */
std::string last_words;
std::terminate_handler usual_end = nullptr;

template <class... Values> [[noreturn]] void end_with_line(const char *format, Values... values) noexcept
{
  while (!line_is_mine && line_is_taken.test_and_set()) {
    if (told_status > 0) {
      remove_unfinished_files();
      _exit(told_status);
    }
    ::usleep(1000); /* another thread is printing */
  }
  char line[1024];
  const int length = std::snprintf(line, sizeof line - 1, format, values...);
  const size_t size = std::min(static_cast<size_t>(std::max(length, 0)), sizeof line - 2);
  std::replace(line, line + size, '\n', ' ');
  line[size] = '\n';
  remove_unfinished_files();
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line, size + 1);
  _exit(1);
}

/* A lack of resources is reported and ends with a status. Anything else is a defect of this program, and is reported as
 * such. */
[[noreturn]] void end_uncaught()
{
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc &) {
    end_with_line("tandem: out of memory in `%.800s` (the last allocation that failed was of %zu bytes)",
                  last_words.c_str(), failed_allocation_bytes());
  } catch (const std::runtime_error &error) {
    end_with_line("tandem: `%.400s` cannot go on, and nothing could be saved: %.400s", last_words.c_str(),
                  error.what());
  } catch (...) {}
  usual_end();
  std::abort();
}

void prepare_last_words(int count, char **arguments)
{
  usual_end = std::set_terminate(end_uncaught);
  last_words = typed(count, arguments);
}

/* For example "`tandem run --help`" for the subcommand that was being parsed. */
std::string where_to_look(const CLI::App &parser)
{
  const std::vector<CLI::App *> parsed = parser.get_subcommands();
  return fmt::format("`tandem {}--help` lists what there is", parsed.empty() ? "" : parsed.front()->get_name() + " ");
}

/* An empty value usually comes from an unset shell variable, so it is refused. */
void refuse_empty_values(const CLI::App &parser)
{
  for (const CLI::Option *option : parser.get_options())
    for (const std::string &value : option->results())
      if (value.empty()) throw InputError(fmt::format("{} '': a value is needed", option->get_name()));
  for (const CLI::App *command : parser.get_subcommands()) refuse_empty_values(*command);
}

std::vector<Command> add_commands(CLI::App &parser)
{
  return {devices_command(parser), scenes_command(parser),    convert_command(parser),        run_command(parser),
          replay_command(parser),  diff_command(parser),      plan_command(parser),           bench_command(parser),
          report_command(parser),  stability_command(parser), contact_problem_command(parser)};
}

int execute_parsed(const std::vector<Command> &commands)
{
  for (const Command &command : commands) {
    if (!command.parser->parsed()) continue;
    const int status = command.execute();
    const std::string shortage = minicl::thread_shortage();
    return shortage.empty() ? status : complain(shortage, status);
  }
  throw InputError("no command given; `tandem --help` lists what there is");
}

int parse_and_execute(int count, char **arguments)
{
  CLI::App parser("Rigid body physics whose every stage is written once and runs on CPU and GPU with the same bits.",
                  "tandem");
  parser.set_version_flag("--version", std::string("tandem ") + version());
  const std::string status =
      "Exit status: 0 fine; 1 the check failed, or the machine did not suffice: memory, threads, the room that "
      "--max-pairs allows, a device;\n"
      "2 bad use or input, or an output that cannot be written.";
  parser.footer(status); /* of commands without their own */
  const std::vector<Command> commands = add_commands(parser);
  parser.footer(
      "SCENE is a file (.json, .gltf, .glb, .urdf, .xml) or name:key=value,... - `tandem scenes` lists the names.\n" +
      status);
  try {
    parser.parse(count, arguments);
  } catch (const CLI::Success &asked) { /* --help, --version */
    std::ostringstream text;            /* CLI11 flushes the stream it prints to, which loses the reason of a failure */
    const int status = parser.exit(asked, text);
    fmt::print("{}", text.str());
    return status;
  } catch (const CLI::ExtrasError &error) {
    if (parser.get_subcommands().empty())
      return complain(fmt::format("unknown command '{}'; {}", arguments[1], where_to_look(parser)), 2);
    return complain(fmt::format("{}; {}", error.what(), where_to_look(parser)), 2);
  } catch (const CLI::ParseError &error) {
    return complain(fmt::format("{}; {}", error.what(), where_to_look(parser)), 2);
  }
  refuse_empty_values(parser);
  return execute_parsed(commands);
}

int guarded(int count, char **arguments)
{
  try {
    return parse_and_execute(count, arguments);
  } catch (const InputError &error) {
    return complain(error.what(), 2);
  } catch (const OutOfMemory &error) {
    return complain(error.what() + failed_allocation(), 1);
  } catch (const std::bad_alloc &) {
    return complain(fmt::format("out of memory in `{}`{}", last_words, failed_allocation()), 1);
  } catch (const std::system_error &error) { /* fmt::print throws one if output fails */
    return std::ferror(stdout) ? complain_of_output(error.code().value()) : complain(error.what(), 1);
  } catch (const std::exception &error) {
    return complain(error.what(), 1);
  }
}

} // namespace
} // namespace tandem

int main(int count, char **arguments)
{
  for (const int signal : {SIGPIPE, SIGXFSZ})
    std::signal(signal, SIG_IGN); /* a write to a closed pipe returns an error */
  tandem::clean_up_when_asked_to_end();
  tandem::prepare_last_words(count, arguments);
  tandem::keep_standard_files_apart();
  return tandem::with_output_written(tandem::guarded(count, arguments));
}
