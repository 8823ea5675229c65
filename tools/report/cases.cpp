/* cases.cpp - see cases.h. */
#include "tools/report/cases.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host/scene.h"

namespace tandem {
namespace {

constexpr std::array<MetricName, 8> metrics = {{
    {Metric::position, "position", "RMS position error", "m"},
    {Metric::rotation, "rotation", "RMS rotation error", "rad"},
    {Metric::max_penetration, "max-penetration", "maximum penetration", "m"},
    {Metric::mean_penetration, "mean-penetration", "mean penetration", "m"},
    {Metric::natural_map, "natural-map", "natural-map residual", "relative"},
    {Metric::fischer_burmeister, "fischer-burmeister", "Fischer-Burmeister residual", "relative"},
    {Metric::cone_violation, "cone", "friction-cone violation", "relative"},
    {Metric::energy, "energy", "energy error", "J"},
}};

constexpr std::array<ReportCase, 7> cases = {{
    {"free-flight", "boxes thrown, spinning about no principal axis; the centres of mass fly on parabolas, known exactly",
     "free-flight:n=16", "free-flight:n=4", 1.0, 0.5, Metric::rotation, 64},
    {"incline", "a box slides down a slope: x = (g/2) (sin - friction cos) t^2", "incline", "incline", 1.0, 0.5, Metric::position, 64},
    {"bounce", "balls of restitution 0.8 fall and bounce twice; parabolas between exact impacts", "bounce:n=16", "bounce:n=4", 1.6, 1.0,
     Metric::position, 64},
    {"pyramid", "a wall of cubes, each resting on two: it must stay where it is", "pyramid:rows=12", "pyramid:rows=5", 1.0, 0.5,
     Metric::position, 64},
    {"box-grid", "layers of boxes, each resting on four: the scene of the published comparisons", "box-grid:nx=6,ny=6,nz=6",
     "box-grid:nx=3,ny=3,nz=3", 2.0, 1.0, Metric::mean_penetration, 16},
    {"mass-ratio", "five cubes, each four times as heavy as the one below: it must stay where it is", "mass-ratio:n=5,ratio=4",
     "mass-ratio:n=4,ratio=4", 1.0, 0.5, Metric::position, 64},
    {"mixed", "a pile of boxes and spheres of seven sizes and four materials; chaotic", "mixed:n=150", "mixed:n=20", 2.0, 1.0,
     Metric::mean_penetration, 16},
}};

template <class Row> std::string names_in(const Row &rows)
{
  std::string names;
  for (const auto &row : rows) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

Settings made(const std::string &solver, uint32_t substeps, uint32_t iterations, float step = base_step)
{
  Settings settings;
  settings.solver = solver;
  settings.substeps = substeps;
  settings.iterations = iterations;
  settings.step = step;
  return settings;
}

/* One pass a substep; the work goes into substeps. */
std::vector<Settings> substep_grid(const std::string &solver)
{
  std::vector<Settings> grid;
  for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u, 32u}) grid.push_back(made(solver, substeps, 1));
  for (const float factor : {2.0f, 0.5f, 0.25f}) grid.push_back(made(solver, 4, 1, base_step * factor));
  for (const uint32_t iterations : {2u, 4u}) grid.push_back(made(solver, 4, iterations));
  return grid;
}

/* One substep a step; the work goes into iterations. */
std::vector<Settings> iteration_grid(const std::string &solver)
{
  std::vector<Settings> grid;
  for (const uint32_t iterations : {1u, 2u, 4u, 8u, 16u, 32u, 64u}) grid.push_back(made(solver, 1, iterations));
  for (const float factor : {2.0f, 0.5f, 0.25f}) grid.push_back(made(solver, 1, 8, base_step * factor));
  for (const uint32_t iterations : {1u, 4u}) grid.push_back(made(solver, 4, iterations));
  return grid;
}

bool solves_by_substeps(const std::string &solver) { return solver == "soft-step" || solver == "xpbd"; }

std::vector<Settings> quick_grid(const std::string &solver)
{
  if (solver == "direct") return {made(solver, 1, 1), made(solver, 4, 1)};
  if (solves_by_substeps(solver)) return {made(solver, 1, 1), made(solver, 4, 1), made(solver, 16, 1)};
  return {made(solver, 1, 4), made(solver, 1, 16), made(solver, 4, 4)};
}

} // namespace

std::span<const MetricName> metric_names() { return metrics; }

const MetricName &name_of(Metric metric) { return metrics[static_cast<size_t>(metric)]; }

Metric metric_named(const std::string &name)
{
  for (const MetricName &metric : metrics)
    if (name == metric.name) return metric.metric;
  throw InputError(fmt::format("unknown metric '{}'; metrics: {}", name, names_in(metrics)));
}

std::span<const ReportCase> report_cases() { return cases; }

const ReportCase &report_case_named(const std::string &name)
{
  for (const ReportCase &report_case : cases)
    if (name == report_case.name) return report_case;
  throw InputError(fmt::format("the report has no scene '{}'; its scenes: {}", name, names_in(cases)));
}

std::vector<Settings> settings_grid(const std::string &solver, bool quick)
{
  if (quick) return quick_grid(solver);
  if (solver == "direct")
    return {made(solver, 1, 1), made(solver, 2, 1), made(solver, 4, 1), made(solver, 1, 1, 2 * base_step), made(solver, 1, 1, base_step / 2),
            made(solver, 1, 1, base_step / 4)};
  return solves_by_substeps(solver) ? substep_grid(solver) : iteration_grid(solver);
}

std::string step_text(const Settings &settings) { return fmt::format("1/{}", std::lround(1.0 / settings.step)); }

std::string short_text(const Settings &settings)
{
  const auto counted = [](uint32_t count, const char *what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); };
  std::string text = counted(settings.substeps, "substep");
  if (settings.iterations != 1 || !solves_by_substeps(settings.solver)) text += ", " + counted(settings.iterations, "iteration");
  if (settings.step != base_step) text += ", dt " + step_text(settings) + " s";
  return text;
}

} // namespace tandem
