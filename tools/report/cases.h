/* cases.h - what the report simulates, how long, and by which error it is judged; and the settings that it tries. */
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
Metric metric_named(const std::string &name); /* InputError lists them */

enum class Grid { quick, coarse, full }; /* how many settings of a solver are tried */

struct ReportCase {
  const char *name, *what;
  const char *scene, *quick_scene; /* specifications of host/catalog/catalog.h; null: not in the quick report */
  double duration, quick_duration; /* s */
  Metric metric;
  uint32_t refinement =
      64; /* the truth's time step is 1/60 s divided by it; 0: too large for a reference, and judged without */
  Grid grid = Grid::full; /* unless the report is quick */
};
std::span<const ReportCase> report_cases();
const ReportCase &report_case_named(const std::string &name); /* InputError lists them */

/* Around the substeps and iterations that the solver asks for: an eighth to eight times on its own knob (substeps if it
 * wants several, else iterations), some of the work on the other, and other time steps. Coarse: a quarter to four
 * times, and the other knob. Quick: a quarter, its own, four times, and the other knob. */
std::vector<Settings> settings_grid(const std::string &solver, Grid size);

/* The time step all others are multiples or fractions of by a power of two: their times then agree to the bit. */
inline constexpr float base_step = 1.0f / 60.0f;

/* "8 substeps", "4 substeps of 2 iterations", "20 iterations, dt 1/120 s": what differs from one pass in 1/60 s. */
std::string short_text(const Settings &settings);
/* "1/60", "1/120", ...: as --dt takes it. */
std::string step_text(const Settings &settings);

} // namespace tandem
