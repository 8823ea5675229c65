/* page_command.cpp - the part of the command that the how-to pages run, `plan` and `diff`. The whole command would take
 * longer to compile than all the rest of their copy of the tree (apply_pages.sh). */
#include <fmt/format.h>

#include <tandem/error.h>

#include "tools/command/command.h"

int main(int count, char **arguments)
{
  CLI::App parser("the subcommands that the pages run");
  const tandem::Command commands[] = {tandem::plan_command(parser), tandem::diff_command(parser)};
  CLI11_PARSE(parser, count, arguments);
  try {
    for (const tandem::Command &command : commands)
      if (command.parser->parsed()) return command.execute();
  } catch (const tandem::InputError &error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return 2;
}
