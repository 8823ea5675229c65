/* chart_test.cpp - ticks at round numbers, the contents of the SVG, and input that could break it. */
#ifdef TANDEM_COMMAND
#include <cmath>
#include <limits>

#include "tests/catch.h"
#include "tools/plot/chart.h"
#include "tools/plot/page.h"

using namespace tandem;

namespace {

size_t count_of(const std::string &text, const std::string &part)
{
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

bool is_one_two_five(double value)
{
  const double digit = value / std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  for (const double allowed : {1.0, 2.0, 5.0})
    if (std::abs(digit - allowed) < 1e-6) return true;
  return false;
}

Chart two_points(double y)
{
  Chart chart{"A & B", {"ms", AxisScale::logarithmic}, {"error, m", AxisScale::logarithmic}};
  chart.series.push_back({"one", {{1, 0.5}, {2, y}}});
  return chart;
}

} // namespace

TEST_CASE("chart: linear ticks are a step of 1, 2 or 5 apart and stay inside", "[chart]")
{
  for (const auto &[low, high] : {std::pair{0.0, 1.0}, {-3.7, 1.1}, {1e-9, 3e-9}, {99990.0, 100010.0}, {-1e12, 1e12}}) {
    const std::vector<double> ticks = ticks_of(low, high, AxisScale::linear);
    CAPTURE(low, high, ticks.size());
    REQUIRE(ticks.size() >= 3);
    CHECK(ticks.size() <= 12);
    CHECK(is_one_two_five(ticks[1] - ticks[0]));
    CHECK(ticks.front() >= low - 1e-6 * (high - low));
    CHECK(ticks.back() <= high + 1e-6 * (high - low));
  }
}

TEST_CASE("chart: logarithmic ticks are decades, or 1, 2, 5 where few decades are shown", "[chart]")
{
  for (const auto &[low, high] : {std::pair{0.05, 20.0}, {1e-12, 1e3}, {1e-300, 1e300}, {2.0, 5.0}}) {
    const std::vector<double> ticks = ticks_of(low, high, AxisScale::logarithmic);
    CAPTURE(low, high, ticks.size());
    REQUIRE(ticks.size() >= 2);
    CHECK(ticks.size() <= 12);
    for (const double tick : ticks) {
      CHECK(is_one_two_five(tick));
      CHECK(tick >= low * 0.999);
      CHECK(tick <= high * 1.001);
    }
  }
  CHECK(ticks_of(2.0, 5.0, AxisScale::logarithmic) == std::vector<double>{2, 5});
}

TEST_CASE("chart: tick texts are short and exact", "[chart]")
{
  CHECK(tick_text(0) == "0");
  CHECK(tick_text(0.002) == "0.002");
  CHECK(tick_text(-2.5) == "-2.5");
  CHECK(tick_text(1e-7) == "10⁻⁷");
  CHECK(tick_text(2e-5) == "2·10⁻⁵");
  CHECK(tick_text(1e12) == "10¹²");
}

TEST_CASE("chart: every point has a marker and a note, and names are escaped", "[chart]")
{
  Chart chart = two_points(0.25);
  chart.series[0].points[1].note = "4 substeps <biased>";
  chart.series[0].points[1].front = true;
  const std::string svg = svg_of(chart);
  CHECK(count_of(svg, "<g class=\"point") == 2);
  CHECK(count_of(svg, "<title>") == 2);
  CHECK(svg.find("A &amp; B") != std::string::npos);
  CHECK(svg.find("<biased>") == std::string::npos);
  CHECK(svg.find("Pareto front") != std::string::npos);
  CHECK(count_of(svg, "<g class=\"point front\"") == 1);
  CHECK(count_of(svg, "<g") == count_of(svg, "</g>"));
  CHECK(svg.find("http") == svg.find("http://www.w3.org/2000/svg")); /* a name, nothing to fetch */
}

TEST_CASE("chart: zero lies hollow on the lower end, infinity is counted, nothing prints nan", "[chart]")
{
  const std::string zero = svg_of(two_points(0));
  CHECK(count_of(zero, "class=\"hollow\"") == 1);
  CHECK(count_of(zero, "<g class=\"point") == 2);
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    const std::string svg = svg_of(two_points(bad));
    CHECK(count_of(svg, "<g class=\"point") == 1);
    CHECK(svg.find("1 point not shown") != std::string::npos);
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
  }
}

TEST_CASE("chart: empty, single and extreme data still give a frame with finite numbers", "[chart]")
{
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic})
    for (const std::vector<ChartPoint> &points : {std::vector<ChartPoint>{},
                                                  {{1, 1}},
                                                  {{1, 0}, {2, 0}},
                                                  {{1e-300, 1e-300}, {1e300, 1e300}},
                                                  {{5, 7}, {5, 7}}}) {
      Chart chart{"edge", {"x", scale}, {"y", scale}};
      chart.series.push_back({"data", points});
      const std::string svg = svg_of(chart);
      CHECK(svg.find("nan") == std::string::npos);
      CHECK(svg.find("inf") == std::string::npos);
      CHECK(count_of(svg, "<g class=\"point") == points.size());
    }
}

TEST_CASE("chart: seven colours differ, and the eighth series has another marker", "[chart]")
{
  for (size_t a = 0; a < 7; ++a)
    for (size_t b = 0; b < a; ++b) CHECK(series_color(a) != series_color(b));
  CHECK(series_color(0) == series_color(7));
}

TEST_CASE("page: one file, escaped text, numbers that sort by value", "[chart]")
{
  Page page("Errors < time", "Why & how");
  page.section("Tables");
  page.table({"all", {"solver", "error"}, {{"b", 2e-9}, {"a", std::nan("")}}});
  page.commands({"tandem report --out <dir>"});
  const std::string text = page.text();
  CHECK(text.find("Errors &lt; time") != std::string::npos);
  CHECK(text.find("--out &lt;dir&gt;") != std::string::npos);
  CHECK(text.find("data-value=\"2.0000000000000001e-09\">2e-09<") != std::string::npos);
  CHECK(text.find("<a href=\"#s1\">Tables</a>") != std::string::npos);
  for (const char *outside : {"http://", "https://", "src=", "@import", "<link"})
    CHECK(text.find(outside) == std::string::npos);
}

TEST_CASE("chart: several stand below each other in one picture", "[chart]")
{
  Chart first = two_points(1), second = two_points(2);
  second.title = "second";
  const std::string svg = svg_of(std::vector<Chart>{first, second});
  CHECK(count_of(svg, "<svg") == 1); /* one within another would be stretched by the style */
  CHECK(count_of(svg, "<style>") == 1);
  CHECK(count_of(svg, "data-name=\"one\"") == 2);
  const size_t below = svg.find("<g transform=\"translate(0 4"); /* 420 px and a legend */
  REQUIRE(below != std::string::npos);
  CHECK(svg.find(">A &amp; B</text>") < below);
  CHECK(svg.find(">second</text>") > below);
}
#endif
