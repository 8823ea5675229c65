/* command.h - the subcommands of `tandem`, one file each.
 *
 * A function adds its options to the parser and returns what to run once they are parsed. Exit status:
 * 0 fine, 1 the check failed (or a device did, or memory or the room of --max-pairs did not suffice), 2 bad use or
 * input, or an output that cannot be written, thrown as InputError.
 */
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace tandem {

struct Command {
  CLI::App *parser;
  std::function<int()> execute;
};

Command devices_command(CLI::App &parser);
Command scenes_command(CLI::App &parser);
Command run_command(CLI::App &parser);
Command diff_command(CLI::App &parser);
Command plan_command(CLI::App &parser);
Command bench_command(CLI::App &parser);
Command report_command(CLI::App &parser);
Command stability_command(CLI::App &parser);
Command contact_problem_command(CLI::App &parser);

} // namespace tandem
