/* cases.h - the scenes that the report simulates, their durations and metrics, and the grids of settings that it
 * tries. */
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tandem/settings.h>

namespace tandem {

/* Errors and residuals of a run; docs/metrics.md defines each. */
enum class Metric {
  position,
  rotation,
  max_penetration,
  mean_penetration,
  natural_map,
  fischer_burmeister,
  cone_violation,
  energy
};
struct MetricName {
  Metric metric;
  const char *name;  /* of --metric */
  const char *label; /* of axes and columns */
  const char *unit;
};
std::span<const MetricName> metric_names();
const MetricName &name_of(Metric metric);
Metric metric_named(const std::string &name); /* InputError lists the names */

enum class Grid { quick, coarse, full }; /* how many settings of a solver are tried */

struct ReportCase {
  const char *name, *what;
  const char *scene, *quick_scene; /* specifications of host/catalog/catalog.h; null: not in the quick report */
  double duration, quick_duration; /* s */
  Metric metric;
  uint32_t refinement =
      64; /* the reference solution's time step is 1/60 s divided by it; 0: the scene is too large for one */
  Grid grid = Grid::full; /* unless the report is quick */
};
std::span<const ReportCase> report_cases();
const ReportCase &report_case_named(const std::string &name); /* InputError lists the names */

/* The grid is centred on the solver's default substeps and iterations. Full: an eighth to eight times on its own
 * setting (substeps if its default has several, else iterations), some of the work on the other setting, and other time
 * steps. Coarse: a quarter to four times, and the other setting. Quick: a quarter, the default, four times, and the
 * other setting. */
std::vector<Settings> settings_grid(const std::string &solver, Grid size);

/* All other time steps are multiples or fractions of this one by a power of two, so that their times agree to the
 * bit. */
inline constexpr float base_step = 1.0f / 60.0f;

/* What differs from one pass in 1/60 s, such as "8 substeps", "4 substeps of 2 iterations" or "20 iterations, dt 1/120
 * s". */
std::string short_text(const Settings &settings);
/* "1/60", "1/120", ..., in the form that --dt accepts. */
std::string step_text(const Settings &settings);

} // namespace tandem
