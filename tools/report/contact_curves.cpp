/* contact_curves.cpp - solves the contact problems of a report; see contact_curves.h. */
#include "tools/report/contact_curves.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "host/runtime/make_backend.h"
#include "host/verify/contact_solver.h"

namespace tandem {
namespace {

constexpr double wished_residual = 1e-8;
constexpr size_t most_points = 60;

/* The time of the whole solve is distributed evenly, because every sweep of a solver does the same work. */
ContactCurve curve_of(const std::string &problem, const std::string &solver, const ContactSolution &solution)
{
  ContactCurve curve{problem, solver, {}};
  const double iterations = static_cast<double>(solution.history.size());
  size_t next = 0;
  for (size_t k = 0; k < solution.history.size(); ++k) {
    if (k < next && k + 1 < solution.history.size()) continue;
    const double done = static_cast<double>(k + 1);
    curve.points.push_back(
        {solution.milliseconds * done / iterations, solution.history[k], fmt::format("{} sweeps", k + 1)});
    next = k + 1 + solution.history.size() / most_points;
  }
  return curve;
}

void add_problems_in(const char *folder, std::vector<std::string> &files)
{
  std::error_code error;
  std::vector<std::string> found;
  for (const auto &entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".dat") found.push_back(entry.path().string());
  std::sort(found.begin(), found.end());
  files.insert(files.end(), found.begin(), found.end());
}

} // namespace

std::vector<ContactCurve> contact_curves(const std::vector<std::string> &files, const std::string &backend, bool quick)
{
  std::vector<ContactCurve> curves;
  for (const std::string &file : files) {
    const ContactProblem problem = read_contact_problem(file);
    for (const auto &[solver, name] : contact_solvers()) {
      const std::unique_ptr<Backend> on = make_backend(solver == ContactSolver::nsgs ? "reference:threads=1" : backend);
      const ContactSolverSettings settings{solver, wished_residual, quick ? 100u : 1000u};
      curves.push_back(
          curve_of(std::filesystem::path(file).stem().string(), name, solve_contact_problem(problem, settings, *on)));
    }
  }
  return curves;
}

std::vector<std::string> usual_contact_problems(bool quick)
{
  std::vector<std::string> files;
  add_problems_in("tests/scenes", files);
  if (!quick) add_problems_in("data/siconos", files);
  return files;
}

} // namespace tandem
