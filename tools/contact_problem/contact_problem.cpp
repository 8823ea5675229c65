/* contact_problem.cpp - `tandem contact-problem`: solves one frictional contact problem with one solver and prints its
 * residual sweep by sweep. */
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/runtime/make_backend.h"
#include "host/verify/contact_solver.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

struct ContactProblemOptions {
  std::string file, solver = "pgs", tolerance = "1e-3", on, iterations = "1000";
  bool inexact = false;
  JsonOutput json;
};

ContactSolverSettings settings_from(const ContactProblemOptions &options)
{
  ContactSolverSettings settings;
  settings.solver = parse_contact_solver(options.solver);
  settings.tolerance = real_number("--tolerance", options.tolerance);
  if (!(settings.tolerance > 0))
    throw InputError(fmt::format("--tolerance {}: must be above 0, as 1e-3", options.tolerance));
  settings.iterations = static_cast<uint32_t>(whole_number("--iterations", options.iterations, 1, 1'000'000));
  return settings;
}

/* nsgs is pgs in double, which only the reference backend supports. */
std::string backend_from(const ContactProblemOptions &options)
{
  const bool reference = options.on.rfind("reference", 0) == 0;
  if (options.solver == "nsgs" && !options.on.empty() && !reference)
    throw InputError(fmt::format(
        "--solver nsgs is double precision, which '{}' is not; leave --on out, or use --on reference", options.on));
  if (!options.on.empty()) return options.on;
  return options.solver == "nsgs" ? "reference" : "tbb";
}

/* Prints the sweeps 1, 2, 5, 10, 20, 50, ... and the last. */
void print_history(const std::vector<double> &history)
{
  Table table({"sweep", "residual"});
  const std::vector<size_t> digits = {1, 2, 5};
  for (size_t power = 1, k = 0; digits[k] * power < history.size(); power *= k == 2 ? 10 : 1, k = (k + 1) % 3)
    table.add({fmt::format("{}", digits[k] * power), fmt::format("{:.3e}", history[digits[k] * power - 1])});
  if (!history.empty()) table.add({fmt::format("{}", history.size()), fmt::format("{:.3e}", history.back())});
  fmt::print("{}", table.text("  "));
}

void print_solution(const ContactProblemOptions &options, const std::string &backend, const ContactProblem &problem,
                    const ContactSolution &solution)
{
  fmt::print("{}: {} contacts, {} blocks; {} on {}\n", options.file, problem.contacts, problem.blocks.size(),
             options.solver, backend);
  print_history(solution.history);
  fmt::print("{} {} sweeps, {:.3f} ms; relative residuals: natural map {:.3e}, Fischer-Burmeister {:.3e}; cone "
             "violation {:.3e} N s\n",
             solution.converged ? "converged in" : "NOT converged after", solution.iterations, solution.milliseconds,
             solution.residuals.natural_map, solution.residuals.fischer_burmeister, solution.residuals.cone_violation);
}

Json solution_json(const ContactProblemOptions &options, const std::string &backend, const ContactProblem &problem,
                   const ContactSolution &solution)
{
  return {{"file", options.file},
          {"contacts", problem.contacts},
          {"solver", options.solver},
          {"backend", backend},
          {"tolerance", real_number("--tolerance", options.tolerance)},
          {"converged", solution.converged},
          {"sweeps", solution.iterations},
          {"residual", solution.residuals.natural_map},
          {"ms", solution.milliseconds},
          {"fischer_burmeister", solution.residuals.fischer_burmeister},
          {"cone_violation", solution.residuals.cone_violation},
          {"history", solution.history},
          {"impulse", solution.impulse}};
}

/* The squares of numbers that fit in floats may overflow. */
void require_finite(const ContactSolution &solution, const ContactProblemOptions &options)
{
  const auto finite = [](double x) { return std::isfinite(x); };
  const auto all_finite = [&](const std::array<double, 3> &impulse) {
    return std::all_of(impulse.begin(), impulse.end(), finite);
  };
  const auto &[natural_map, fischer_burmeister, cone_violation] = solution.residuals;
  if (finite(natural_map) && finite(fischer_burmeister) && finite(cone_violation) &&
      std::all_of(solution.impulse.begin(), solution.impulse.end(), all_finite))
    return;
  throw InputError(fmt::format(
      "{}: the range of {} numbers does not suffice for --solver {}: what it computes from W, q and mu is not finite; "
      "use smaller units{}",
      options.file, options.solver == "nsgs" ? "64-bit" : "32-bit", options.solver,
      options.solver == "nsgs" ? "" : ", or --solver nsgs"));
}

int execute(const ContactProblemOptions &options)
{
  const ContactSolverSettings settings = settings_from(options);
  const std::string where = backend_from(options);
  DistinctFiles files;
  files.reads("FILE", options.file);
  options.json.check(files);
  const ContactProblem problem = read_contact_problem(options.file);
  const std::unique_ptr<Backend> backend = make_backend(where, options.inexact);
  const ContactSolution solution = solve_contact_problem(problem, settings, *backend);
  require_finite(solution, options);
  if (!options.json.takes_standard_output()) print_solution(options, where, problem, solution);
  options.json.write(solution_json(options, where, problem, solution));
  return solution.converged ? 0 : 1;
}

} // namespace

Command contact_problem_command(CLI::App &parser)
{
  CLI::App *command =
      parser.add_subcommand("contact-problem", "solve a frictional contact problem in Siconos's text format");
  auto options = std::make_shared<ContactProblemOptions>();
  command->add_option("FILE", options->file, "the problem: dim, nc, storage, W, q, mu")->required()->type_name("");
  command->add_option("--solver", options->solver, "pgs, nncg, jacobi, or nsgs: pgs in double")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--tolerance", options->tolerance, "relative natural-map residual to reach")
      ->type_name("T")
      ->capture_default_str();
  command->add_option("--on", options->on, "backend: tbb, or reference for nsgs, unless given")->type_name("B");
  command->add_option("--iterations", options->iterations, "sweeps at most")->type_name("N")->capture_default_str();
  command->add_flag("--inexact", options->inexact, "accept devices that fail the exactness self-test");
  command->add_option("--json", options->json.path, "write the result as JSON; - for standard output")
      ->type_name("FILE");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
