/* main.cpp - the command `tandem`: parses, runs one subcommand, turns errors into one line. */
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/out_of_memory.h"
#include "host/scene.h"
#include "tools/command.h"
#include "tools/failed_allocation.h"

namespace tandem {
namespace {

/* Scripts read one line an error, whatever a library put into its message. */
int complain(std::string message, int status)
{
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  fmt::print(stderr, "tandem: {}\n", message);
  return status;
}

std::string typed(int count, char **arguments)
{
  std::string text = "tandem";
  for (int k = 1; k < count; ++k) text += fmt::format(" {}", arguments[k]);
  return text;
}

/* "`tandem run --help`" for the subcommand that was being parsed. */
std::string where_to_look(const CLI::App &parser)
{
  const std::vector<CLI::App *> parsed = parser.get_subcommands();
  return fmt::format("`tandem {}--help` lists what there is", parsed.empty() ? "" : parsed.front()->get_name() + " ");
}

std::vector<Command> add_commands(CLI::App &parser)
{
  std::vector<Command> commands = {devices_command(parser), scenes_command(parser), run_command(parser),
                                   diff_command(parser),    plan_command(parser),   bench_command(parser),
                                   report_command(parser), stability_command(parser), contact_problem_command(parser)};
  for (Command &command : later_commands(parser)) commands.push_back(std::move(command));
  return commands;
}

int execute_parsed(const std::vector<Command> &commands)
{
  for (const Command &command : commands)
    if (command.parser->parsed()) return command.execute();
  throw InputError("no command given; `tandem --help` lists what there is");
}

int parse_and_execute(int count, char **arguments)
{
  CLI::App parser("Rigid body physics whose every stage is written once and runs on CPU and GPU with the same bits.",
                  "tandem");
  parser.set_version_flag("--version", "tandem " TANDEM_VERSION);
  parser.footer("SCENE is a file (.json, .gltf, .glb) or name:key=value,... - `tandem scenes` lists the names.\n"
                "Exit status: 0 fine, 1 the check failed, 2 bad use or input.");
  const std::vector<Command> commands = add_commands(parser);
  try {
    parser.parse(count, arguments);
  } catch (const CLI::Success &asked) { /* --help, --version */
    return parser.exit(asked);
  } catch (const CLI::ExtrasError &error) {
    if (parser.get_subcommands().empty()) return complain(fmt::format("unknown command '{}'; {}", arguments[1], where_to_look(parser)), 2);
    return complain(fmt::format("{}; {}", error.what(), where_to_look(parser)), 2);
  } catch (const CLI::ParseError &error) {
    return complain(fmt::format("{}; {}", error.what(), where_to_look(parser)), 2);
  }
  return execute_parsed(commands);
}

} // namespace
} // namespace tandem

int main(int count, char **arguments)
{
  try {
    return tandem::parse_and_execute(count, arguments);
  } catch (const tandem::InputError &error) {
    return tandem::complain(error.what(), 2);
  } catch (const tandem::OutOfMemory &error) {
    return tandem::complain(error.what() + tandem::failed_allocation(), 1);
  } catch (const std::bad_alloc &) {
    return tandem::complain(fmt::format("out of memory in `{}`{}", tandem::typed(count, arguments), tandem::failed_allocation()), 1);
  } catch (const std::exception &error) {
    return tandem::complain(error.what(), 1);
  }
}
