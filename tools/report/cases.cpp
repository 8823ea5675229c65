/* cases.cpp - the tables of metrics and cases, and the grids of settings; see cases.h. */
#include "tools/report/cases.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tandem/scene.h>

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

constexpr std::array<ReportCase, 8> cases = {{
    {"free-flight",
     "boxes thrown, spinning about no principal axis; the centres of mass fly on parabolas, known exactly",
     "free-flight:n=16", "free-flight:n=4", 1.0, 0.5, Metric::rotation, 64},
    {"incline", "a box slides down a slope: x = (g/2) (sin - friction cos) t^2", "incline", "incline", 1.0, 0.5,
     Metric::position, 64},
    {"bounce", "balls of restitution 0.8 fall and bounce twice; parabolas between exact impacts", "bounce:n=16",
     "bounce:n=4", 1.6, 1.0, Metric::position, 64},
    {"pyramid", "a wall of cubes, each resting on two: it must stay where it is", "pyramid:rows=12", "pyramid:rows=5",
     1.0, 0.5, Metric::position, 64},
    {"box-grid", "layers of boxes, each resting on four: the scene of the published comparisons",
     "box-grid:nx=6,ny=6,nz=6", "box-grid:nx=3,ny=3,nz=3", 2.0, 1.0, Metric::mean_penetration, 16},
    {"box-grid-large", "the same with 8,000 boxes, enough to fill a GPU", "box-grid:nx=20,ny=20,nz=20", nullptr, 1.0, 0,
     Metric::mean_penetration, 0, Grid::coarse},
    {"mass-ratio", "five cubes, each four times as heavy as the one below: it must stay where it is",
     "mass-ratio:n=5,ratio=4", "mass-ratio:n=4,ratio=4", 1.0, 0.5, Metric::position, 64},
    {"mixed", "a pile of boxes and spheres of seven sizes and four materials; chaotic", "mixed:n=150", "mixed:n=20",
     2.0, 1.0, Metric::mean_penetration, 16},
}};

template <class Row> std::string names_in(const Row &rows)
{
  std::string names;
  for (const auto &row : rows) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

uint32_t &knob_of(Settings &settings, bool substeps) { return substeps ? settings.substeps : settings.iterations; }

/* A solver's default work, times `factor` on its own setting (substeps or iterations). */
Settings with_work(const std::string &solver, double factor, float step = base_step)
{
  Settings settings = settings_for(parse_setting<Solver>(solver));
  settings.step = step;
  uint32_t &knob = knob_of(settings, settings.substeps > 1);
  knob = std::clamp<uint32_t>(static_cast<uint32_t>(std::lround(knob * factor)), 1, 1000);
  return settings;
}

/* Moves some of the work to the other setting: several passes a substep, or several substeps of fewer passes. */
Settings with_other_knob(const std::string &solver, uint32_t count)
{
  Settings settings = settings_for(parse_setting<Solver>(solver));
  const bool by_substeps = settings.substeps > 1;
  uint32_t &own = knob_of(settings, by_substeps), &other = knob_of(settings, !by_substeps);
  other = count;
  if (!by_substeps) own = std::max(own / count, 1u);
  return settings;
}

/* Different small factors may give the same settings. */
std::vector<Settings> without_repetition(const std::vector<Settings> &all)
{
  std::vector<Settings> grid;
  const auto same = [](const Settings &a, const Settings &b) {
    return a.substeps == b.substeps && a.iterations == b.iterations && a.step == b.step;
  };
  for (const Settings &settings : all)
    if (std::none_of(grid.begin(), grid.end(), [&](const Settings &known) { return same(known, settings); }))
      grid.push_back(settings);
  return grid;
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

std::vector<Settings> settings_grid(const std::string &solver, Grid size)
{
  std::vector<Settings> grid;
  if (size != Grid::full) {
    for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0})
      if (size == Grid::coarse || (factor != 0.5 && factor != 2.0)) grid.push_back(with_work(solver, factor));
    grid.push_back(with_other_knob(solver, 4));
    return without_repetition(grid);
  }
  for (const double factor : {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) grid.push_back(with_work(solver, factor));
  for (const uint32_t count : {2u, 4u}) grid.push_back(with_other_knob(solver, count));
  for (const float factor : {2.0f, 0.5f, 0.25f}) grid.push_back(with_work(solver, 1, base_step * factor));
  return without_repetition(grid);
}

std::string step_text(const Settings &settings) { return fmt::format("1/{}", std::lround(1.0 / settings.step)); }

std::string short_text(const Settings &settings)
{
  const auto counted = [](uint32_t count, const char *what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  std::string text = counted(settings.substeps, "substep");
  if (settings.iterations > 1)
    text = (settings.substeps == 1 ? "" : text + " of ") + counted(settings.iterations, "iteration");
  if (settings.step != base_step) text += ", dt " + step_text(settings) + " s";
  return text;
}

} // namespace tandem
