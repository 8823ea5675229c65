/* equal_error.cpp - chooses levels of error and the cheapest run for each; see equal_error.h. */
#include "tools/report/equal_error.h"

#include <algorithm>
#include <cmath>

#include "tools/report/pareto.h"

namespace tandem {
namespace {

constexpr size_t most_levels = 5, most_decades = 32;

std::vector<double> spread_evenly(const std::vector<double> &levels)
{
  if (levels.size() <= most_levels) return levels;
  std::vector<double> kept;
  for (size_t k = 0; k < most_levels; ++k)
    kept.push_back(levels[(k * (levels.size() - 1) + (most_levels - 1) / 2) / (most_levels - 1)]);
  return kept;
}

std::vector<double> levels_of(const std::vector<std::vector<Run>> &by_backend, Metric metric, double finest)
{
  std::vector<Tradeoff> points;
  for (const std::vector<Run> &runs : by_backend)
    for (const Run &run : runs) points.push_back({run.cost(), run.error(metric)});
  std::vector<double> levels = sensible_wishes(points, most_decades);
  std::erase_if(levels, [finest](double level) { return level < finest; });
  return spread_evenly(levels);
}

std::vector<std::string> solvers_in(const std::vector<std::vector<Run>> &by_backend)
{
  std::vector<std::string> solvers;
  for (const std::vector<Run> &runs : by_backend)
    for (const Run &run : runs)
      if (std::find(solvers.begin(), solvers.end(), run.solver) == solvers.end()) solvers.push_back(run.solver);
  return solvers;
}

std::optional<size_t> cheapest_of(const std::vector<Run> &runs, const std::string &solver, Metric metric, double level)
{
  std::vector<Tradeoff> points; /* not finite for runs of other solvers, which are therefore never chosen */
  for (const Run &run : runs) points.push_back({run.solver == solver ? run.cost() : NAN, run.error(metric)});
  return cheapest_within(points, level);
}

} // namespace

std::vector<EqualError> equal_errors(const std::vector<std::vector<Run>> &by_backend, Metric metric, double finest)
{
  std::vector<EqualError> rows;
  for (const double level : levels_of(by_backend, metric, finest))
    for (const std::string &solver : solvers_in(by_backend)) {
      EqualError row{level, solver, {}};
      for (const std::vector<Run> &runs : by_backend) row.runs.push_back(cheapest_of(runs, solver, metric, level));
      rows.push_back(row);
    }
  return rows;
}

} // namespace tandem
