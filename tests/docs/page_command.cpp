/* page_command.cpp - the command as far as the how-to pages run it, `plan` and `diff`: the whole of it would take
 * longer to compile than all else that their copy of the tree needs (apply_pages.sh). */
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
