/* report_test.cpp - `tandem report`: the front against brute force, the sentence, and a tiny report opened in a
 * browser. */
#ifdef TANDEM_COMMAND
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "tests/tools/command/command_line.h"
#include "tools/report/collect.h"

using namespace tandem;

namespace {

using command_line::contents;
using command_line::Json;
using command_line::Result;
using command_line::Scratch;
using command_line::shell;
namespace files = std::filesystem;

void check_report_refused(const std::string &arguments, const std::string &mentions)
{
  command_line::check_refused("report " + arguments, mentions);
}

bool beats(const Tradeoff &a, const Tradeoff &b)
{
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}
bool equals(const Tradeoff &a, const Tradeoff &b) { return a.cost == b.cost && a.error == b.error; }

std::vector<size_t> front_by_brute_force(const std::vector<Tradeoff> &points)
{
  std::vector<size_t> front;
  for (size_t i = 0; i < points.size(); ++i) {
    bool kept = std::isfinite(points[i].cost) && std::isfinite(points[i].error);
    for (size_t j = 0; j < points.size(); ++j) {
      if (!std::isfinite(points[j].cost) || !std::isfinite(points[j].error)) continue;
      if (beats(points[j], points[i]) || (j < i && equals(points[j], points[i]))) kept = false;
    }
    if (kept) front.push_back(i);
  }
  std::sort(front.begin(), front.end(), [&](size_t a, size_t b) { return points[a].cost < points[b].cost; });
  return front;
}

Run run_of(const char *solver, double milliseconds, double error, uint32_t substeps = 1)
{
  Run run;
  run.solver = solver;
  run.backend = "tbb";
  run.settings.solver = parse_setting<Solver>(solver);
  run.settings.substeps = substeps;
  run.settings.step = base_step;
  run.step_milliseconds = milliseconds;
  run.errors.fill(error);
  return run;
}

/* One report for all that looks at it. */
const files::path &tiny_report()
{
  static const Scratch folder;
  static const Result result = command_line::command(
      "report --quick --scenes incline,pyramid --solvers soft-step --on serial,tbb:threads=1,lanes=4 "
      "--problems '" TANDEM_SOURCE_DIR "/tests/scenes/box-on-corners.dat' --out '" +
      folder.file("new/folder") + "'");
  INFO(result.out << result.error);
  REQUIRE(result.status == 0);
  static const files::path path = folder.path / "new/folder";
  return path;
}

std::string browser()
{
  for (const char *name : {"chromium", "chromium-browser", "google-chrome"})
    if (shell(std::string("command -v ") + name).status == 0) return name;
  return "";
}

/* The contents of the page after its script has run. */
std::string page_in_browser(const std::string &query)
{
  const Scratch profile;
  return shell("timeout 60 " + browser() + " --headless --no-sandbox --disable-gpu --user-data-dir='" +
               profile.path.string() + "' --dump-dom 'file://" + (tiny_report() / "report.html").string() + query + "'")
      .out;
}

size_t occurrences(const std::string &text, const std::string &part)
{
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/* The values of one column of the k-th table, as they stand. */
std::vector<double> column_of(const std::string &page, size_t table, size_t column)
{
  size_t at = 0;
  for (size_t k = 0; k <= table; ++k) at = page.find("<table", at + 1);
  const std::string body = page.substr(at, page.find("</table>", at) - at);
  std::vector<double> values;
  for (size_t row = body.find("<tr>", body.find("<tbody")); row != std::string::npos;
       row = body.find("<tr>", row + 1)) {
    size_t cell = row;
    for (size_t c = 0; c <= column; ++c) cell = body.find("<td", cell + 1);
    const size_t value = body.find("data-value=\"", cell);
    values.push_back(std::stod(body.substr(value + 12)));
  }
  return values;
}

} // namespace

TEST_CASE("report: the Pareto front is that of brute force", "[report]")
{
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Tradeoff> points;
    for (uint32_t k = random.below(12); k > 0; --k)
      points.push_back({double(random.below(6)), double(random.below(6))});
    if (trial % 3 == 0) points.push_back({std::nan(""), 0});
    if (trial % 5 == 0) points.push_back({0, std::numeric_limits<double>::infinity()});
    CHECK(pareto_front(points) == front_by_brute_force(points));
    for (const double wished : {0.0, 2.5, 9.0}) {
      std::optional<size_t> best;
      for (size_t i = 0; i < points.size(); ++i)
        if (std::isfinite(points[i].cost) && points[i].error <= wished &&
            (!best || points[i].cost < points[*best].cost))
          best = i;
      const auto found = cheapest_within(points, wished);
      REQUIRE(found.has_value() == best.has_value());
      if (best) CHECK(points[*found].cost == points[*best].cost);
      if (best) CHECK(points[*found].error <= wished);
    }
  }
}

TEST_CASE("report: the sentence names the cheapest setting that keeps each error", "[report]")
{
  std::vector<Run> runs = {run_of("jacobi", 1, 0.03), run_of("pgs", 2, 0.004), run_of("soft-step", 3, 0.0002, 8),
                           run_of("xpbd", 5, 0.02, 4), run_of("avbd", 0.5, std::nan(""))};
  const std::vector<Pick> picks = pick_settings(runs, Metric::position, 0);
  REQUIRE(picks.size() == 3);
  CHECK(picks[0].run == 0);
  CHECK(picks[1].run == 1);
  CHECK(picks[2].run == 2);
  CHECK(runs[0].front);
  CHECK_FALSE(runs[3].front);
  CHECK_FALSE(runs[4].front);
  CHECK(pick_sentence(runs, picks, Metric::position) ==
        "For an RMS position error of at most 100 mm take jacobi with 1 substep (1 ms for 1/60 s); for 10 mm pgs with "
        "1 substep "
        "(2 ms for 1/60 s); for 1 mm soft-step with 8 substeps (3 ms for 1/60 s).");
  CHECK(pick_settings(runs, Metric::position, 0.005).size() == 2); /* finer than the truth is known */
  runs = {run_of("pgs", 1, std::nan(""))};
  CHECK(pick_settings(runs, Metric::position, 0).empty());
  CHECK(pick_sentence(runs, {}, Metric::position).find("nothing to pick") != std::string::npos);
}

TEST_CASE("report: a smaller time step costs more for the same simulated time", "[report]")
{
  Run run = run_of("pgs", 2, 0.1);
  CHECK(run.cost() == Approx(2));
  run.settings.step = base_step / 4;
  CHECK(run.cost() == Approx(8));
  CHECK(short_text(run.settings) == "1 substep, dt 1/240 s");
  run.settings.iterations = 20;
  CHECK(short_text(run.settings) == "20 iterations, dt 1/240 s");
  run.settings.substeps = 4;
  CHECK(short_text(run.settings) == "4 substeps of 20 iterations, dt 1/240 s");
}

TEST_CASE("report: every solver has settings, also in the quick report, and all are valid", "[report]")
{
  for (const std::string &solver : choice_names<Solver>())
    for (const Grid size : {Grid::quick, Grid::coarse, Grid::full}) {
      const std::vector<Settings> grid = settings_grid(solver, size);
      CHECK(grid.size() >= 2);
      for (const Settings &settings : grid) {
        CHECK_NOTHROW(validate(settings));
        CHECK(name_of(settings.solver) == solver);
        CHECK(std::exp2(std::round(std::log2(settings.step / base_step))) * base_step == settings.step);
      }
    }
}

TEST_CASE("report: bad input is one line and status 2", "[report][command]")
{
  const Scratch folder;
  const std::string out = " --out '" + folder.path.string() + "'";
  check_report_refused("--quick", "--out");
  check_report_refused("--scenes castle" + out, "castle");
  check_report_refused("--scenes pyramid,," + out, "--scenes");
  check_report_refused("--solvers magic" + out, "magic");
  check_report_refused("--metric beauty" + out, "beauty");
  check_report_refused("--on gpu" + out, "gpu");
  check_report_refused("--parts scenes,fun" + out, "fun");
  check_report_refused("--quick --scenes box-grid-large" + out, "box-grid-large");
  check_report_refused("--problems missing.dat" + out, "missing.dat");
  check_report_refused("--quick --out /proc/nowhere/report", "/proc/nowhere/report");
  std::ofstream(folder.path / "file") << "taken";
  check_report_refused("--quick --out '" + folder.file("file") + "'", "file");
  CHECK(files::is_empty(folder.path) == false);
  CHECK_FALSE(files::exists(folder.path / "report.html"));
}

TEST_CASE("report: CSV and JSON tell the same, and every backend the same error", "[report][command]")
{
  const Json json = Json::parse(contents(tiny_report() / "report.json"));
  std::istringstream csv(contents(tiny_report() / "report.csv"));
  std::string line;
  REQUIRE(std::getline(csv, line));
  std::vector<std::string> header;
  std::istringstream names(line);
  for (std::string name; std::getline(names, name, ',');) header.push_back(name);
  const auto column = [&](const char *name) {
    return size_t(std::find(header.begin(), header.end(), name) - header.begin());
  };
  std::vector<Json> runs;
  for (const Json &scene : json["scenes"])
    for (const Json &run : scene["runs"]) runs.push_back(run);
  const size_t grid = settings_grid("soft-step", Grid::quick).size();
  CHECK(runs.size() == 4 * grid); /* two scenes, two backends */
  for (const Json &run : runs) {
    REQUIRE(std::getline(csv, line));
    std::vector<std::string> cells;
    bool quoted = false;
    cells.emplace_back();
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) cells.emplace_back();
      else cells.back() += c;
    }
    REQUIRE(cells.size() == header.size());
    for (const char *name : {"ms_per_step", "position", "mean-penetration", "natural-map", "energy"})
      CHECK(std::stod(cells[column(name)]) == run[name].get<double>());
    CHECK(cells[column("solver")] == run["solver"]);
    CHECK(cells[column("backend")] == run["backend"]);
    CHECK(cells[column("body_hash")] == run["body_hash"]);
  }
  CHECK_FALSE(std::getline(csv, line));
  for (const Json &scene : json["scenes"]) {
    const Json &compared = scene["runs"];
    for (size_t k = 0; k < grid; ++k) {
      CHECK(compared[k]["backend"] == "serial");
      CHECK(compared[k + grid]["backend"] == "tbb:threads=1,lanes=4");
      CHECK(compared[k]["errors_from"] == compared[k + grid]["errors_from"]);
      CHECK(compared[k]["body_hash"] == compared[k + grid]["body_hash"]);
      CHECK(compared[k]["position"] == compared[k + grid]["position"]);
    }
  }
}

TEST_CASE("report: errors taken over from another backend are those that it would have found itself", "[report]")
{
  const Scene scene = load_scene("pyramid:rows=3");
  const double duration = 0.2;
  const Truth truth = find_truth(scene, duration, 8);
  for (const char *solver : {"soft-step", "direct"}) {
    const Run observed =
        run_experiment(scene, duration, truth, settings_for(parse_setting<Solver>(solver)), "tbb:lanes=4");
    const Run timed = time_experiment(scene, duration, truth, observed, "serial"),
              own = run_experiment(scene, duration, truth, settings_for(parse_setting<Solver>(solver)), "serial");
    INFO(solver << " " << timed.failure);
    CHECK(timed.backend == "serial");
    CHECK(timed.observed_on == "tbb:lanes=4");
    CHECK(own.observed_on == "serial");
    CHECK_FALSE(timed.unequal);
    CHECK(timed.hash == own.hash);
    CHECK(timed.steps == own.steps);
    CHECK(timed.step_milliseconds > 0);
    for (const MetricName &metric : metric_names()) CHECK(timed.error(metric.metric) == own.error(metric.metric));
    CHECK(timed.mean_height_error == own.mean_height_error);
    Run planted = observed;
    planted.hash ^= 1;
    const Run unequal = time_experiment(scene, duration, truth, planted, "serial");
    CHECK(unequal.unequal);
    CHECK(std::isnan(unequal.error(Metric::position)));
    CHECK(unequal.failure.find("tbb:lanes=4") != std::string::npos);
  }
}

TEST_CASE("report: the reference is observed by itself, for its bits are its own", "[report]")
{
  const Scene scene = load_scene("incline");
  const Truth truth = find_truth(scene, 0.1, 8);
  const Run observed = run_experiment(scene, 0.1, truth, Settings{}, "serial");
  const Run reference = time_experiment(scene, 0.1, truth, observed, "reference");
  CHECK(reference.observed_on == "reference");
  CHECK_FALSE(reference.unequal);
  CHECK(reference.error(Metric::position) != observed.error(Metric::position));
}

TEST_CASE("report: a scene too large for a truth is judged by what needs none", "[report]")
{
  const Run run = run_experiment(load_scene("box-grid:nx=2,ny=2,nz=2"), 0.2, Truth{}, Settings{}, "serial");
  CHECK(run.failure.empty());
  CHECK(run.steps == 12);
  CHECK(run.error(Metric::max_penetration) > 0);
  CHECK(std::isnan(run.error(Metric::position)));
  CHECK(std::isnan(run.error(Metric::energy)));
}

TEST_CASE("report: at equal error the cheapest of each solver on each backend, by brute force", "[report]")
{
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<std::vector<Run>> by_backend(2);
    std::vector<double> errors;
    for (uint32_t k = 2 + random.below(10); k > 0; --k) errors.push_back(std::pow(10.0, random.uniform(-8, 1)));
    for (std::vector<Run> &runs : by_backend)
      for (size_t k = 0; k < errors.size(); ++k)
        runs.push_back(run_of(k % 2 ? "pgs" : "xpbd", random.uniform(1, 100), errors[k]));
    const double finest = trial % 2 ? 1e-5 : 0;
    std::set<double> levels;
    for (const EqualError &row : equal_errors(by_backend, Metric::position, finest)) {
      levels.insert(row.error);
      CHECK(row.error >= finest);
      CHECK(std::log10(row.error) == Approx(std::round(std::log10(row.error))).margin(1e-9));
      REQUIRE(row.runs.size() == 2);
      for (size_t backend = 0; backend < 2; ++backend) {
        const std::vector<Run> &runs = by_backend[backend];
        std::optional<double> cheapest;
        for (const Run &run : runs)
          if (run.solver == row.solver && run.error(Metric::position) <= row.error)
            cheapest = std::min(cheapest.value_or(run.cost()), run.cost());
        REQUIRE(row.runs[backend].has_value() == cheapest.has_value());
        if (cheapest) CHECK(runs[*row.runs[backend]].cost() == *cheapest);
        if (cheapest) CHECK(runs[*row.runs[backend]].solver == row.solver);
      }
    }
    CHECK(levels.size() <= 5);
    if (finest == 0) { /* from what costs least to the best that any reaches */
      REQUIRE_FALSE(levels.empty());
      const double best = *std::min_element(errors.begin(), errors.end());
      CHECK(*levels.begin() >= best);
      CHECK(*levels.begin() < 10 * best * (1 + 1e-9));
    }
  }
}

TEST_CASE("report: the table of equal error holds no setting that keeps less, or costs more than another",
          "[report][command]")
{
  const Json json = Json::parse(contents(tiny_report() / "report.json"));
  for (const Json &scene : json["scenes"]) {
    const std::string metric = scene["metric"];
    REQUIRE(scene["equal_error"].size() >= 2);
    for (const Json &row : scene["equal_error"]) {
      std::optional<double> cheapest;
      for (const Json &run : scene["runs"])
        if (run["backend"] == row["backend"] && run["solver"] == row["solver"] &&
            run[metric].get<double>() <= row["error"].get<double>())
          cheapest = std::min(cheapest.value_or(run["ms_per_60th"]), run["ms_per_60th"].get<double>());
      REQUIRE(row["ms_per_60th"].is_null() == !cheapest.has_value());
      if (cheapest) CHECK(row["ms_per_60th"].get<double>() == *cheapest);
    }
  }
}

TEST_CASE("report: the truth converges, and more work brings less error", "[report][command]")
{
  const Json json = Json::parse(contents(tiny_report() / "report.json"));
  for (const Json &scene : json["scenes"]) {
    const Json &refinement = scene["truth"]["refinement"];
    CHECK(refinement[1]["position"] < refinement[0]["position"]);
    CHECK(scene["truth"]["order"].get<double>() > 0.8);
    CHECK(scene["runs"][2]["position"].get<double>() < 0.5 * scene["runs"][0]["position"].get<double>());
    REQUIRE(scene["backends"].size() == 2);
    for (const Json &backend : scene["backends"]) {
      CHECK(backend["picks"].size() >= 1);
      CHECK(backend["sentence"].get<std::string>().find("soft-step") != std::string::npos);
    }
  }
  CHECK(json["rounding"]["near"]["launches"].get<int>() > 100);
}

TEST_CASE("report: each solver has its curve on each contact problem", "[report][command]")
{
  const Json curves = Json::parse(contents(tiny_report() / "report.json"))["contact_problems"];
  REQUIRE(curves.size() == 4);
  for (const Json &curve : curves) {
    CHECK(curve["problem"] == "box-on-corners");
    const Json &points = curve["points"];
    REQUIRE(points.size() >= 2);
    CHECK(points.back()["residual"].get<double>() < 0.1 * points.front()["residual"].get<double>());
    CHECK(points.back()["ms"].get<double>() > points.front()["ms"].get<double>());
  }
}

TEST_CASE("report: the page stands alone and shows charts and tables in a browser, where sorting works",
          "[report][command]")
{
  const std::string page = contents(tiny_report() / "report.html");
  for (const char *outside : {"src=", "@import", "<link", "url("}) CHECK(page.find(outside) == std::string::npos);
  if (browser().empty()) tests::skip("no Chromium: the page was not looked at");
  const std::string dom = page_in_browser("?sort=2.5&sort=4.5&sort=4.5");
  const size_t runs = 2 * settings_grid("soft-step", Grid::quick).size(); /* of a scene, on two backends */
  CHECK(occurrences(dom, "<svg") == 7); /* two scenes on two backends, a contact problem, two trees of links */
  CHECK(occurrences(dom, "ms per step at equal error") == 2);
  CHECK(occurrences(dom, "<g class=\"point") > 2 * runs);
  CHECK(occurrences(dom, "<table") >= 6);
  CHECK(occurrences(dom, "aria-sort=\"ascending\"") == 1);
  CHECK(occurrences(dom, "aria-sort=\"descending\"") == 1);
  const std::vector<double> up = column_of(dom, 2, 5), down = column_of(dom, 4, 5);
  REQUIRE(up.size() == runs);
  REQUIRE(down.size() == up.size());
  CHECK(std::is_sorted(up.begin(), up.end()));
  CHECK(std::is_sorted(down.rbegin(), down.rend()));
}
#endif
