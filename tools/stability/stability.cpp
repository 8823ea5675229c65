/* stability.cpp - `tandem stability`: runs stiff and extreme cases, each with a figure and a bound, solver by
 * solver. */
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/world.h>

#include "host/runtime/backend_list.h"
#include "tools/command/command.h"
#include "tools/command/marked_table.h"
#include "tools/command/output.h"
#include "tools/command/parallel.h"
#include "tools/command/progress.h"
#include "tools/stability/batch.h"
#include "tools/stability/cases.h"
#include "tools/stability/counts.h"
#include "tools/stability/results.h"
#include "tools/stability/table.h"

namespace tandem {
namespace {

using stability::Case;
using stability::Length;

struct StabilityOptions {
  std::string only, except, groups, except_groups, solvers, on = "tbb", out, between, substeps;
  size_t at_once = 0; /* 0: one for each processor */
  bool quick = false, list = false, inexact = false, bounds = false;
  MarkedTable table;
  JsonOutput json;
};

std::vector<std::string> split(const std::string &text)
{
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/* Throws InputError unless each name is that of a case. */
std::vector<std::string> case_names_in(const char *option, const std::string &text)
{
  std::vector<std::string> known;
  for (const Case &each : stability::all_cases()) known.push_back(each.name);
  const std::vector<std::string> names = split(text);
  for (const std::string &name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("{}: no case '{}'; the cases are {}", option, name, fmt::join(known, ", ")));
  return names;
}

/* Throws InputError unless each name is that of a group. */
std::vector<std::string> group_names_in(const char *option, const std::string &text)
{
  std::vector<std::string> known;
  for (const Case &each : stability::all_cases())
    if (known.empty() || known.back() != each.group) known.push_back(each.group);
  const std::vector<std::string> names = split(text);
  for (const std::string &name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("{}: no group '{}'; the groups are {}", option, name, fmt::join(known, ", ")));
  return names;
}

/* The case with substeps that the world chooses, unless it is about their number. */
Case with_automatic_substeps(const Case &given)
{
  Case automatic = given;
  automatic.build = [given](Length length) {
    stability::Trial trial = given.build(length);
    if (!trial.keeps_substeps) trial.settings.substeps = automatic_substeps;
    trial.own_passes = true;
    return trial;
  };
  return automatic;
}

const std::vector<Case> &cases_of(const StabilityOptions &options)
{
  if (options.substeps.empty()) return stability::all_cases();
  if (options.solvers != name_of(Solver::soft_step))
    throw InputError("--substeps auto: only soft-step chooses its substeps; add --solvers soft-step");
  static const std::vector<Case> automatic = [] {
    std::vector<Case> all;
    for (const Case &each : stability::all_cases()) all.push_back(with_automatic_substeps(each));
    return all;
  }();
  return automatic;
}

std::vector<const Case *> chosen_cases(const StabilityOptions &options)
{
  const std::vector<std::string> wanted = case_names_in("--only", options.only),
                                 unwanted = case_names_in("--except", options.except),
                                 groups = group_names_in("--groups", options.groups),
                                 other_groups = group_names_in("--except-groups", options.except_groups);
  const auto named = [](const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<const Case *> chosen;
  for (const Case &each : cases_of(options))
    if ((options.only.empty() || named(wanted, each.name)) && !named(unwanted, each.name) &&
        (options.groups.empty() || named(groups, each.group)) && !named(other_groups, each.group))
      chosen.push_back(&each);
  if (chosen.empty()) throw InputError("--except, --groups and --except-groups: no case is left");
  return chosen;
}

std::vector<std::string> chosen_solvers(const StabilityOptions &options)
{
  const std::vector<std::string> known = choice_names<Solver>();
  if (options.solvers.empty()) return known;
  const std::vector<std::string> wanted = split(options.solvers);
  for (const std::string &name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--solvers: '{}' is unknown; use {}", name, fmt::join(known, ", ")));
  return wanted;
}

/* The folder is made before the first case runs, so that a long run does not end without its results. */
void prepare_folder(const std::string &folder, DistinctFiles &files)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError(fmt::format("--out {}: cannot make this folder: {}", folder, error.message()));
  for (const char *name : {"stability.json", "figures.csv", "index.html"}) files.writes("--out", folder + "/" + name);
}

std::string verdict(const stability::Outcome &outcome)
{
  const stability::CheckResult &headline = outcome.headline;
  return fmt::format("{:24} {:10} {} {:7.1f} s  {:.3g} {} ({}), bound {:.3g}{}", outcome.name, outcome.solver,
                     outcome.refused  ? "none"
                     : outcome.passed ? "pass"
                                      : "FAIL",
                     1e-3 * outcome.milliseconds, headline.figure, headline.unit, headline.what, headline.bound.value,
                     outcome.note.empty() ? "" : "; " + outcome.note);
}

/* A backend that does not exist, or solvers that it cannot run, are bad use, which must be found before the first
 * case. */
void check_backend(const Placement &placement)
{
  Scene scene = stability::empty_scene();
  stability::add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0, 0});
  World(scene, {}, placement).step();
}

stability::Outcome run_with_progress(const Case &which, const std::string &solver, const Placement &placement,
                                     Length length)
{
  Progress progress(fmt::format("{} {}", which.name, solver), which.build(length).steps);
  return run_case(which, length, solver, placement, [&](uint64_t done, uint64_t) { progress.update(done); });
}

/* Names of groups may hold spaces. */
std::string quoted(const std::string &text)
{
  return text.find(' ') == std::string::npos ? text : fmt::format("'{}'", text);
}

/* The command line that repeats the run; without the output files if the text is for a table in a page. */
std::string command_text(const StabilityOptions &options, bool files = true)
{
  std::string text = "tandem stability";
  const auto add = [&](const char *name, const std::string &value) {
    if (!value.empty()) text += fmt::format(" {} {}", name, value);
  };
  add("--only", options.only);
  add("--except", options.except);
  add("--groups", quoted(options.groups));
  add("--except-groups", quoted(options.except_groups));
  add("--solvers", options.solvers);
  add("--substeps", options.substeps);
  add("--on", options.on == "tbb" ? "" : options.on);
  if (options.at_once > 0) text += fmt::format(" --cases-in-parallel {}", options.at_once);
  if (files) add("--out", options.out);
  if (files) add("--table-in", options.table.path);
  if (files) add("--table", options.table.name);
  return text + (options.quick ? " --quick" : "") + (options.bounds ? " --bounds" : "");
}

/* The bounds of the default solver must be close to its figures, because a bound far above would hide a regression. */
int conclude_bounds(const stability::Results &results)
{
  const size_t loose = stability::loose_bounds(results, results.solvers.front());
  if (!loose) return 0;
  fmt::print(stderr, "tandem: {} bounds are more than ten times the figure of {} and state no derivation\n", loose,
             results.solvers.front());
  return 1;
}

/* The status is 1 unless the first solver, which is the default one unless it was left out, passes every case. */
int conclude(const stability::Results &results)
{
  std::vector<std::string> failed;
  for (const stability::Result &result : results.results)
    if (!result.outcome.passed && result.outcome.solver == results.solvers.front())
      failed.push_back(result.outcome.name);
  if (failed.empty()) return 0;
  fmt::print(stderr, "tandem: {} fails {} of {} cases: {}\n", results.solvers.front(), failed.size(),
             results.results.size() / results.solvers.size(), fmt::join(failed, ", "));
  return 1;
}

/* On a device only one world runs at a time, because all would share one queue. */
size_t runs_at_once(const StabilityOptions &options)
{
  const bool device = options.on.starts_with("cl");
  if (device && options.at_once > 1)
    throw InputError(fmt::format("--cases-in-parallel {}: on {} cases run one at a time", options.at_once, options.on));
  if (options.at_once > 0) return options.at_once;
  return device ? 1 : processor_count();
}

/* Writes the file after each case, so that an interrupted run leaves its results. */
void save(const StabilityOptions &options, const Json &json)
{
  write_file("--out", options.out + "/stability.json", json.dump(1) + "\n");
}

/* Prints verdicts in their fixed order, so a run that ends before an earlier one waits for it. `told` is the number
 * already printed. */
void tell(const stability::Results &so_far, size_t &told)
{
  for (; told < so_far.results.size() && so_far.results[told].place == told; ++told)
    fmt::print("{}\n", verdict(so_far.results[told].outcome));
  std::fflush(stdout);
}

void tell_end(const StabilityOptions &options, const stability::Results &results)
{
  if (options.bounds) fmt::print("{}", stability::bounds_text(results));
  for (const std::string &solver : results.solvers)
    fmt::print("{}: {}\n", solver, stability::text_of(stability::counts_of(results, solver)));
  fmt::print("{}/index.html\n", options.out);
}

int run_cases(const StabilityOptions &options)
{
  const std::vector<const Case *> cases = chosen_cases(options);
  const std::vector<std::string> solvers = chosen_solvers(options);
  const Placement placement{options.on, {}, options.inexact};
  const Length length = options.quick ? Length::quick : Length::full;
  if (options.out.empty())
    throw InputError("--out DIR is needed: the folder for the page, stability.json and figures.csv");
  DistinctFiles files;
  check_backend(placement);
  prepare_folder(options.out, files);
  options.json.check(files);
  options.table.check(files);
  size_t told = 0;
  const stability::Results results = stability::run_batch({cases, solvers, placement, length, runs_at_once(options)},
                                                          [&](const stability::Results &so_far) {
                                                            save(options, stability::results_json(so_far));
                                                            if (!options.json.takes_standard_output())
                                                              tell(so_far, told);
                                                          });
  const Json json = stability::results_json(results);
  write_file("--out", options.out + "/figures.csv", stability::series_csv(results));
  write_file("--out", options.out + "/index.html", stability::results_page(results, command_text(options)));
  options.table.write(stability::markdown_of(results, command_text(options, false)));
  if (!options.json.takes_standard_output()) tell_end(options, results);
  options.json.write(json);
  const int status = options.bounds ? conclude_bounds(results) : 0;
  return conclude(results) | status;
}

/* Runs every case, shortened, on every backend and compares the bits, whether or not the solver passes. */
int compare_backends(const StabilityOptions &options)
{
  const std::vector<std::string> backends = split_backends(options.between);
  if (backends.size() < 2) throw InputError(fmt::format("--between '{}': name two backends or more", options.between));
  const std::vector<const Case *> cases = chosen_cases(options);
  const std::vector<std::string> solvers = chosen_solvers(options);
  options.json.check();
  for (const std::string &backend : backends) check_backend({backend, {}, options.inexact});
  Json list = Json::array();
  size_t unequal = 0;
  for (const Case *each : cases)
    for (const std::string &solver : solvers) {
      if (refuses(solver, each->build(Length::brief))) continue;
      Json hashes = Json::object();
      bool equal = true;
      std::string first;
      for (const std::string &backend : backends) {
        const stability::Outcome outcome =
            run_with_progress(*each, solver, {backend, {}, options.inexact}, Length::brief);
        const std::string hash = outcome.end.empty() ? outcome.note : hash_text(outcome.body_hash);
        if (first.empty()) first = hash;
        equal = equal && hash == first && !outcome.end.empty();
        hashes[backend] = hash;
      }
      unequal += !equal;
      if (!options.json.takes_standard_output())
        fmt::print("{:28} {:10} {} {}\n", each->name, solver, equal ? "equal" : "UNEQUAL",
                   equal ? first : hashes.dump());
      std::fflush(stdout);
      list.push_back({{"name", each->name}, {"solver", solver}, {"equal", equal}, {"body_hash", hashes}});
    }
  options.json.write({{"backends", backends}, {"equal", unequal == 0}, {"cases", list}});
  if (unequal)
    fmt::print(stderr, "tandem: {} of {} runs differ between {}\n", unequal, list.size(), fmt::join(backends, ", "));
  return unequal ? 1 : 0;
}

int list_cases(const StabilityOptions &options)
{
  std::string group;
  for (const Case *each : chosen_cases(options)) {
    if (each->group != group) fmt::print("{}\n", group = each->group);
    fmt::print("  {:26} {}\n", each->name, each->what);
  }
  return 0;
}

int execute(const StabilityOptions &options)
{
  if (options.list) return list_cases(options);
  return options.between.empty() ? run_cases(options) : compare_backends(options);
}

} // namespace

Command stability_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("stability", "stiff and extreme cases, each with a figure and a bound");
  auto options = std::make_shared<StabilityOptions>();
  command->add_option("--only", options->only, "these cases alone")->type_name("CASE,...");
  command->add_option("--except", options->except, "all but these cases")->type_name("CASE,...");
  command->add_option("--groups", options->groups, "the cases of these groups alone")->type_name("GROUP,...");
  command->add_option("--except-groups", options->except_groups, "all but the cases of these groups")
      ->type_name("GROUP,...");
  command->add_option("--solvers", options->solvers, "these solvers alone")->type_name("NAME,...");
  command
      ->add_option("--substeps", options->substeps,
                   "auto: cases that are not about substeps run with as many as needed")
      ->type_name("auto")
      ->check(CLI::IsMember({"auto"}));
  command->add_option("--on", options->on, "backend")->type_name("B")->capture_default_str();
  command->add_option("--out", options->out, "write the results into this folder")->type_name("DIR");
  command->add_option("--json", options->json.path, "write the results as JSON; - for standard output")
      ->type_name("FILE");
  command
      ->add_option("--between", options->between,
                   "no figures: every case, shortened, on each of these backends must end in the same bits")
      ->type_name("B,B,...");
  command
      ->add_option("--cases-in-parallel", options->at_once,
                   "runs side by side (default: one for each processor; on devices one)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--table-in", options->table.path,
                   "write the table of the run between the marks of this Markdown page")
      ->type_name("FILE");
  command->add_option("--table", options->table.name, "the name of the table in this page, if it has several")
      ->type_name("NAME");
  command->add_flag("--bounds", options->bounds,
                    "list figure, bound and ratio of every check; status 1 if a ratio above ten states no derivation");
  command->add_flag("--list", options->list, "name the cases that are chosen")
      ->excludes("--json")
      ->excludes("--table-in");
  command->add_flag("--inexact", options->inexact, "accept devices that fail the exactness self-test");
  command->footer("Exit status: 0 if the default solver (or the first of --solvers) passes every case, 1 if not or if "
                  "memory did not suffice, 2 for bad use or an output that cannot be written.");
  command->add_flag("--quick", options->quick, "shorter versions of the long cases, named as such");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
