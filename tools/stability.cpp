/* stability.cpp - `tandem stability`: stiff and extreme cases, each with its figure and bound, solver by solver. */
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/world.h"
#include "tools/command.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/stability/cases.h"
#include "tools/stability/results.h"

namespace tandem {
namespace {

using stability::Case;
using stability::Length;

struct StabilityOptions {
  std::string only, solvers, on = "tbb", out, between;
  bool quick = false, list = false, inexact = false;
  JsonOutput json;
};

std::vector<std::string> split(const std::string &text)
{
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<const Case *> chosen_cases(const StabilityOptions &options)
{
  std::vector<const Case *> chosen;
  std::vector<std::string> wanted = split(options.only);
  for (const Case &each : stability::all_cases()) {
    const auto named = std::find(wanted.begin(), wanted.end(), each.name);
    if (!options.only.empty() && named == wanted.end()) continue;
    chosen.push_back(&each);
    if (named != wanted.end()) wanted.erase(named);
  }
  if (!wanted.empty()) {
    std::vector<std::string> names;
    for (const Case &each : stability::all_cases()) names.push_back(each.name);
    throw InputError(fmt::format("--only: no case '{}'; the cases are {}", wanted.front(), fmt::join(names, ", ")));
  }
  return chosen;
}

std::vector<std::string> chosen_solvers(const StabilityOptions &options)
{
  const std::vector<std::string> known = solver_names();
  if (options.solvers.empty()) return known;
  const std::vector<std::string> wanted = split(options.solvers);
  for (const std::string &name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--solvers: '{}' is unknown; use {}", name, fmt::join(known, ", ")));
  return wanted;
}

/* The folder is made before the first case runs: a long run must not end without its results. */
void prepare_folder(const std::string &folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) throw InputError(fmt::format("--out {}: cannot make this folder: {}", folder, error.message()));
  check_writable("--out", folder + "/stability.json");
}

std::string verdict(const stability::Outcome &outcome)
{
  const stability::CheckResult &headline = outcome.headline;
  return fmt::format("{:24} {:10} {}  {:.3g} {} ({}), bound {:.3g}{}", outcome.name, outcome.solver, outcome.passed ? "pass" : "FAIL", headline.figure,
                     headline.unit, headline.what, headline.bound, outcome.note.empty() ? "" : "; " + outcome.note);
}

int execute(const StabilityOptions &options)
{
  const std::vector<const Case *> cases = chosen_cases(options);
  const std::vector<std::string> solvers = chosen_solvers(options);
  const Placement placement{options.on, {}, options.inexact};
  const Length length = options.quick ? Length::quick : Length::full;
  options.json.check();
  if (!options.out.empty()) prepare_folder(options.out);
  stability::Results results{options.on, solvers, length, {}};
  for (const Case *each : cases)
    for (const std::string &solver : solvers) {
      const stability::Trial trial = each->build(length);
      Progress progress(fmt::format("{} {}", each->name, solver), trial.steps);
      stability::Outcome outcome = run_trial(reported_name(*each, length), trial, solver, placement, [&](uint64_t done, uint64_t) { progress.update(done); });
      progress.clear();
      if (!options.json.takes_standard_output()) {
        fmt::print("{}\n", verdict(outcome));
        std::fflush(stdout);
      }
      results.add(*each, trial, std::move(outcome));
    }
  const Json json = stability::results_json(results);
  if (!options.out.empty()) write_file("--out", options.out + "/stability.json", json.dump(1) + "\n");
  if (!options.out.empty()) write_file("--out", options.out + "/figures.csv", stability::series_csv(results));
  options.json.write(json);
  return 0;
}

} // namespace

Command stability_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("stability", "stiff and extreme cases, each with a figure and a bound");
  auto options = std::make_shared<StabilityOptions>();
  command->add_option("--only", options->only, "these cases alone")->type_name("CASE,...");
  command->add_option("--solvers", options->solvers, "these solvers alone")->type_name("NAME,...");
  command->add_option("--on", options->on, "backend")->type_name("B")->capture_default_str();
  command->add_option("--out", options->out, "write the results into this folder")->type_name("DIR");
  command->add_option("--json", options->json.path, "write the results as JSON; - for standard output")->type_name("FILE");
  command->add_flag("--quick", options->quick, "shorter versions of the long cases, named as such");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
