/* command.h - the subcommands of `tandem`, one file each.
 *
 * A function adds its options to the parser and returns what to run once they are parsed. The exit status is 0 for
 * success; 1 if a check failed, a device failed, or memory or --max-pairs did not suffice; 2 for bad use, bad input or
 * an output that cannot be written, which are thrown as InputError.
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
Command convert_command(CLI::App &parser);
Command run_command(CLI::App &parser);
Command replay_command(CLI::App &parser);
Command diff_command(CLI::App &parser);
Command plan_command(CLI::App &parser);
Command bench_command(CLI::App &parser);
Command report_command(CLI::App &parser);
Command stability_command(CLI::App &parser);
Command contact_problem_command(CLI::App &parser);

} // namespace tandem
