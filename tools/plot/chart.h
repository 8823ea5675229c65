/* chart.h - line charts as self-contained SVG, for `tandem report` and `tandem stability`.
 *
 *   y  10⁻² |  o                      ringed, dashed: the Pareto front (nothing is both faster and better)
 *           |   `--o---.              every point is a <g> with a <title>: browsers show it on hover
 *      10⁻³ |      (o)- - -(o)        series differ in colour and in marker, so colour is never alone
 *           +-----|-----|-----|  x
 *              0.1     1     10       ticks 1, 2, 5 or decades
 *
 * The colours are those of Okabe and Ito's palette, which colour-blind readers can distinguish, that are legible on
 * white and on black. Text and axes take the colour of their surroundings, so pages may be dark or light.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tandem {

enum class AxisScale { linear, logarithmic };

struct ChartPoint {
  double x = 0, y = 0;
  std::string note = {}; /* shown on hover, under the values */
  bool joined = true;    /* the series' line runs through it */
  bool front = false;    /* on the Pareto front: ringed, and joined by the dashed line */
};

struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points = {}; /* in the order in which the line joins them */
  bool markers = true;
  bool dashed = false;
};

struct ChartAxis {
  std::string label;
  AxisScale scale = AxisScale::linear;
  /* The axis includes these values if given, and always the data. On a logarithmic axis they must be above 0. */
  std::optional<double> lowest = std::nullopt, highest = std::nullopt;
};

/* A horizontal line with its name at its right end, such as a bound or a target. */
struct ChartLevel {
  double y;
  std::string name;
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series = {};
  std::vector<ChartLevel> levels = {};
  double width = 760, height = 420; /* px, without the legend, which goes below */
};

/* Values that a logarithmic axis cannot show (0 and less) are drawn hollow at its lower end, with their true values in
 * the note. Points that are not finite are omitted and counted under the chart. */
std::string svg_of(const Chart &chart);
/* One picture of several charts, one below the other. */
std::string svg_of(const std::vector<Chart> &charts);

/* The ticks of an axis over [low, high]: multiples of 1, 2 or 5 times a power of ten, or decades. Requires low < high;
 * there are at most about ten. */
std::vector<double> ticks_of(double low, double high, AxisScale scale);

/* The colour of the k-th series, "#rrggbb"; colours repeat after seven, with other markers. */
std::string series_color(size_t k);

/* A short text for ticks, such as "0.002", "5" or "10⁻⁷". */
std::string tick_text(double value);

} // namespace tandem
