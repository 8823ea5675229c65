/* later.cpp - commands of the contract that are not built yet, so that scripts get a clear answer. */
#include <fmt/format.h>

#include <tandem/scene.h>

#include "tools/command.h"

namespace tandem {

std::vector<Command> later_commands(CLI::App &parser)
{
  std::vector<Command> commands;
  for (const char *name : {"replay"}) {
    CLI::App *command = parser.add_subcommand(name, "comes with a later version");
    command->allow_extras();
    commands.push_back({command, [name]() -> int {
                          throw InputError(
                              fmt::format("`tandem {}` is not built yet: it comes with a later version", name));
                        }});
  }
  return commands;
}

} // namespace tandem
