/* chart.cpp - lays out axes, series and legend and writes them as SVG; see chart.h. */
#include "tools/plot/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/plot/markup.h"

namespace tandem {
namespace {

constexpr double left = 72, right = 20, top = 34, bottom = 50, legend_row = 20,
                 letter = 6.6; /* px; letter: mean width of a letter */

/* One axis, mapped to pixels. */
class Ruler {
public:
  Ruler(const ChartAxis &axis, std::vector<double> values, double from, double to)
      : scale_(axis.scale), from_(from), to_(to)
  {
    if (axis.lowest) values.push_back(*axis.lowest);
    if (axis.highest) values.push_back(*axis.highest);
    std::erase_if(values, [&](double v) { return !std::isfinite(v) || (logarithmic() && v <= 0); });
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    low_ = values.empty() ? (logarithmic() ? 0.1 : 0) : *low;
    high_ = values.empty() ? 1 : *high;
    if (logarithmic()) widen_to_ticks();
    else widen_evenly();
  }

  bool logarithmic() const { return scale_ == AxisScale::logarithmic; }
  bool shows(double value) const { return std::isfinite(value) && (!logarithmic() || value > 0); }
  double at(double value) const
  {
    if (logarithmic() && value <= 0) return from_;
    const double share = logarithmic() ? (std::log(value) - std::log(low_)) / (std::log(high_) - std::log(low_))
                                       : (value - low_) / (high_ - low_);
    return from_ + share * (to_ - from_);
  }
  std::vector<double> ticks() const { return ticks_of(low_, high_, scale_); }

private:
  /* Extends the range to the next 1, 2 or 5, and to at least half a decade, so that noise does not fill a chart. */
  void widen_to_ticks()
  {
    if (high_ < low_ * 3) {
      const double middle = std::sqrt(low_) * std::sqrt(high_);
      low_ = middle / 1.8, high_ = middle * 1.8;
    }
    low_ = std::max(low_ * 0.9, std::numeric_limits<double>::min());
    high_ = std::min(high_ * 1.1, std::numeric_limits<double>::max() / 2);
    low_ = step_of(low_, false), high_ = step_of(high_, true);
  }
  static double step_of(double value, bool up)
  {
    const double decade = std::pow(10.0, std::floor(std::log10(value)));
    double below = decade;
    for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
      if (digit * decade >= value * (1 - 1e-12)) return up ? digit * decade : below;
      below = digit * decade;
    }
    return below;
  }
  void widen_evenly()
  {
    double span = high_ - low_;
    if (span <= 1e-12 * std::max(std::abs(low_), std::abs(high_))) span = std::max(std::abs(high_), 1.0);
    const bool from_zero = low_ >= 0 && low_ < 0.3 * high_;
    low_ = from_zero ? 0 : low_ - 0.05 * span;
    high_ += 0.05 * span;
  }

  AxisScale scale_;
  double from_, to_, low_ = 0, high_ = 1;
};

std::vector<double> values_of(const Chart &chart, bool x)
{
  std::vector<double> values;
  for (const ChartSeries &series : chart.series)
    for (const ChartPoint &point : series.points) values.push_back(x ? point.x : point.y);
  if (!x)
    for (const ChartLevel &level : chart.levels) values.push_back(level.y);
  return values;
}

struct PlotFrame {
  explicit PlotFrame(const Chart &chart)
      : x(chart.x, values_of(chart, true), left, chart.width - right),
        y(chart.y, values_of(chart, false), chart.height - bottom, top)
  {}
  Ruler x, y;
};

bool drawable(const ChartPoint &point) { return std::isfinite(point.x) && std::isfinite(point.y); }

std::string grid_text(const Chart &chart, const PlotFrame &frame)
{
  std::string text;
  for (const double value : frame.x.ticks())
    text += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
                        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
                        frame.x.at(value), top, chart.height - bottom, chart.height - bottom + 17, tick_text(value));
  for (const double value : frame.y.ticks())
    text +=
        fmt::format("<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
                    "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                    frame.y.at(value), left, chart.width - right, left - 7, frame.y.at(value) + 4, tick_text(value));
  return text;
}

std::string labels_text(const Chart &chart)
{
  const double middle = (top + chart.height - bottom) / 2;
  return fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top,
                     chart.width - left - right, chart.height - top - bottom) +
         fmt::format("<text class=\"title\" x=\"{}\" y=\"19\">{}</text>\n", left, escaped(chart.title)) +
         fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + chart.width - right) / 2,
                     chart.height - 13, escaped(chart.x.label)) +
         fmt::format("<text x=\"16\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {0})\">{1}</text>\n",
                     middle, escaped(chart.y.label));
}

std::string levels_text(const Chart &chart, const PlotFrame &frame)
{
  std::string text;
  for (const ChartLevel &level : chart.levels) {
    if (!frame.y.shows(level.y)) continue;
    text += fmt::format("<line class=\"level\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>", left,
                        chart.width - right, frame.y.at(level.y));
    text += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", chart.width - right - 6,
                        frame.y.at(level.y) - 5, escaped(level.name));
  }
  return text;
}

/* A marker around (0, 0). Series differ in which of five markers they have. */
std::string marker_text(size_t series, bool hollow)
{
  static constexpr std::array<const char *, 5> shapes = {
      "<circle r=\"4.2\"{0}/>", "<rect x=\"-3.8\" y=\"-3.8\" width=\"7.6\" height=\"7.6\"{0}/>",
      "<path d=\"M0-5L4.8 3.6H-4.8Z\"{0}/>", "<path d=\"M0-5.4L5.4 0L0 5.4L-5.4 0Z\"{0}/>",
      "<path d=\"M0 5L4.8-3.6H-4.8Z\"{0}/>"};
  const std::string shape = shapes[series % shapes.size()];
  const size_t place = shape.find("{0}");
  return shape.substr(0, place) + (hollow ? " class=\"hollow\"" : "") + shape.substr(place + 3);
}

std::string polyline_text(const std::vector<ChartPoint> &points, const PlotFrame &frame, const std::string &attributes)
{
  std::string text;
  for (const ChartPoint &point : points)
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", frame.x.at(point.x), frame.y.at(point.y));
  return points.size() < 2 ? "" : fmt::format("<polyline {} points=\"{}\"/>\n", attributes, text);
}

std::string point_text(const ChartPoint &point, const std::string &series, const Chart &chart, const PlotFrame &frame,
                       size_t index)
{
  const bool hollow = !frame.x.shows(point.x) || !frame.y.shows(point.y);
  const std::string title = fmt::format("{}\n{}: {:.4g}\n{}: {:.4g}{}{}", series, chart.x.label, point.x, chart.y.label,
                                        point.y, point.note.empty() ? "" : "\n", point.note);
  return fmt::format("<g class=\"point{}\" transform=\"translate({:.1f} {:.1f})\"><title>{}</title>{}{}</g>\n",
                     point.front ? " front" : "", frame.x.at(point.x), frame.y.at(point.y), escaped(title),
                     point.front ? "<circle class=\"ring\" r=\"8\"/>" : "", marker_text(index, hollow));
}

std::string series_text(const Chart &chart, const PlotFrame &frame, size_t index)
{
  const ChartSeries &series = chart.series[index];
  std::vector<ChartPoint> line;
  std::string markers;
  for (const ChartPoint &point : series.points) {
    if (!drawable(point)) continue;
    if (point.joined) line.push_back(point);
    if (series.markers) markers += point_text(point, series.name, chart, frame, index);
  }
  return fmt::format("<g class=\"series\" data-name=\"{}\" style=\"color:{}\">\n{}{}</g>\n", escaped(series.name),
                     series_color(index),
                     polyline_text(line, frame, series.dashed ? "class=\"line dashed\"" : "class=\"line\""), markers);
}

std::string front_text(const Chart &chart, const PlotFrame &frame)
{
  std::vector<ChartPoint> front;
  for (const ChartSeries &series : chart.series)
    for (const ChartPoint &point : series.points)
      if (point.front && drawable(point)) front.push_back(point);
  std::sort(front.begin(), front.end(), [](const ChartPoint &a, const ChartPoint &b) { return a.x < b.x; });
  return polyline_text(front, frame, "class=\"pareto\"");
}

bool has_front(const Chart &chart)
{
  for (const ChartSeries &series : chart.series)
    for (const ChartPoint &point : series.points)
      if (point.front) return true;
  return false;
}

size_t letters_of(const std::string &text)
{
  return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

struct Legend {
  std::string text;
  double height = 0;
};

/* Entries follow each other, and a new row begins when the width is used up. */
Legend legend_of(const Chart &chart)
{
  Legend legend;
  double x = left, y = chart.height + 6;
  const auto add = [&](const std::string &name, const std::string &symbol) {
    const double width = 26 + letter * static_cast<double>(letters_of(name)) + 14;
    if (x > left && x + width > chart.width - right) x = left, y += legend_row;
    legend.text += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}<text x=\"22\" y=\"4\">{}</text></g>\n", x,
                               y, symbol, escaped(name));
    x += width;
  };
  for (size_t k = 0; k < chart.series.size(); ++k)
    add(chart.series[k].name,
        fmt::format("<g class=\"key\" style=\"color:{}\"><line class=\"line\" x1=\"0\" x2=\"18\" y1=\"0\" y2=\"0\"/>"
                    "<g transform=\"translate(9 0)\">{}</g></g>",
                    series_color(k), chart.series[k].markers ? marker_text(k, false) : ""));
  if (has_front(chart))
    add("Pareto front", "<g><line class=\"pareto\" x1=\"0\" x2=\"18\" y1=\"0\" y2=\"0\"/><circle class=\"ring\" "
                        "cx=\"9\" r=\"6\"/></g>");
  legend.height = y - chart.height + legend_row;
  return legend;
}

std::string missing_text(const Chart &chart, double y)
{
  size_t missing = 0;
  for (const ChartSeries &series : chart.series)
    missing += static_cast<size_t>(
        std::count_if(series.points.begin(), series.points.end(), [](const ChartPoint &p) { return !drawable(p); }));
  if (missing == 0) return "";
  return fmt::format("<text class=\"missing\" x=\"{}\" y=\"{}\">{} not shown: not finite</text>\n", left, y,
                     missing == 1 ? "1 point" : fmt::format("{} points", missing));
}

double whole_height(const Chart &chart)
{
  return chart.height + legend_of(chart).height + (missing_text(chart, 0).empty() ? 0 : legend_row);
}

constexpr const char *chart_style =
    "<style>.tandem-chart{font:12px system-ui,sans-serif;color:#1c2530;fill:currentColor;max-width:100%;height:auto}"
    "@media(prefers-color-scheme:dark){.tandem-chart{color:#dfe5ec}}"
    ".tandem-chart .title{font-size:14px;font-weight:600}.tandem-chart .missing{opacity:.7}"
    ".tandem-chart .frame{fill:none;stroke:currentColor;opacity:.5}.tandem-chart .grid{stroke:currentColor;opacity:.13}"
    ".tandem-chart .line{fill:none;stroke:currentColor;stroke-width:1.6}.tandem-chart .dashed{stroke-dasharray:6 4}"
    ".tandem-chart .hollow{fill:none;stroke:currentColor;stroke-width:1.6}"
    ".tandem-chart .level{stroke:currentColor;stroke-dasharray:2 4;opacity:.7}"
    ".tandem-chart .pareto{fill:none;stroke:currentColor;stroke-width:1.4;stroke-dasharray:5 4;opacity:.75}"
    ".tandem-chart .ring{fill:none;stroke:currentColor;stroke-width:1.4}.tandem-chart "
    ".point:hover{stroke:currentColor;stroke-width:2}</style>\n";

std::string contents_of(const Chart &chart)
{
  const PlotFrame frame(chart);
  const Legend legend = legend_of(chart);
  std::string text = grid_text(chart, frame) + labels_text(chart) + levels_text(chart, frame);
  for (size_t k = 0; k < chart.series.size(); ++k) text += series_text(chart, frame, k);
  return text + front_text(chart, frame) + legend.text + missing_text(chart, chart.height + legend.height + 4);
}

std::vector<double> linear_ticks(double low, double high)
{
  const double rough = (high - low) / 6, decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double digit : {5.0, 2.0, 1.0})
    if (digit * decade >= rough) step = digit * decade;
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step == 0 ? 0.0 : k * step);
  return ticks;
}

std::vector<double> logarithmic_ticks(double low, double high)
{
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9)),
            last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  const int stride = std::max(1, (last - first + 9) / 10);
  const bool digits = std::log10(high) - std::log10(low) < 3.3;
  std::vector<double> ticks;
  for (int decade = first; decade <= last; decade += stride)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double tick = digit * std::pow(10.0, decade);
      if ((digits || digit == 1) && tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push_back(tick);
    }
  return ticks;
}

} // namespace

std::vector<double> ticks_of(double low, double high, AxisScale scale)
{
  return scale == AxisScale::logarithmic ? logarithmic_ticks(low, high) : linear_ticks(low, high);
}

std::string series_color(size_t k)
{
  static constexpr std::array<const char *, 7> colors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                         "#e69f00", "#56b4e9", "#8c8c8c"};
  return colors[k % colors.size()];
}

std::string tick_text(double value)
{
  const double size = std::abs(value);
  if (size == 0 || (size > 0.99e-3 && size < 1e5)) return fmt::format("{:.6g}", value);
  static constexpr std::array<const char *, 10> raised = {"⁰", "¹", "²", "³", "⁴",
                                                            "⁵", "⁶", "⁷", "⁸", "⁹"};
  const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const double digits = value / std::pow(10.0, exponent);
  std::string power = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent))) power += raised[static_cast<size_t>(c - '0')];
  return fmt::format("{}10{}", std::abs(digits - 1) < 1e-9 ? "" : fmt::format("{:.4g}·", digits), power);
}

std::string svg_of(const Chart &chart) { return svg_of(std::vector<Chart>{chart}); }

std::string svg_of(const std::vector<Chart> &charts)
{
  double width = 0, height = 0;
  std::string names, text;
  for (const Chart &chart : charts) {
    names += (names.empty() ? "" : "; ") + escaped(chart.title);
    text += charts.size() == 1 ? contents_of(chart)
                               : fmt::format("<g transform=\"translate(0 {})\">\n{}</g>\n", height, contents_of(chart));
    width = std::max(width, chart.width);
    height += whole_height(chart);
  }
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"tandem-chart\" role=\"img\" aria-label=\"{0}\" "
                     "viewBox=\"0 0 {1} {2}\" width=\"{1}\" height=\"{2}\">\n{3}{4}</svg>\n",
                     names, width, height, chart_style, text);
}

} // namespace tandem
