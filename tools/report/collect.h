/* collect.h - runs everything that a report shows. What it finds is plain data; page.cpp and data.cpp write it down. */
#pragma once

#include <string>
#include <vector>

#include "host/verify/rounding.h"
#include "tools/report/equal_error.h"
#include "tools/report/experiment.h"
#include "tools/report/pareto.h"

namespace tandem {

struct ReportRequest {
  bool quick = false;
  std::vector<const ReportCase *> cases;
  std::vector<std::string> solvers;
  std::vector<std::string> backends; /* every scene on each; contact problems on the first */
  std::optional<Metric> metric;      /* instead of each scene's own */
  std::vector<std::string> problems; /* files of contact problems */
  bool with_problems = true, with_rounding = true;
  std::string command; /* as it was typed */
};

/* The setting to take for a wished error. */
struct Pick {
  double target_error;
  size_t run;
};

/* One diagram: every solver with every setting on one backend. */
struct BackendRuns {
  std::string backend;
  std::vector<Run> runs; /* the same settings in the same order on every backend */
  std::vector<Pick> picks;
};

struct SceneReport {
  const ReportCase *source = nullptr;
  std::string specification;
  Scene scene;
  double duration = 0;
  Metric metric{};
  Truth truth;
  std::vector<BackendRuns> backends;
  std::vector<EqualError> equal_errors;

  /* Errors below this say nothing: the truth itself is not known better. */
  double uncertainty() const;
};

/* Residual over time of one solver on one contact problem. */
struct ContactCurve {
  std::string problem, solver;
  struct Point {
    double milliseconds, residual;
    std::string note;
  };
  std::vector<Point> points;
};

struct RoundingReport {
  std::string scene;
  double far; /* m: the second table is of the scene moved so far along x */
  RoundingTable candidate_table, far_table;
};

struct Report {
  ReportRequest request;
  std::vector<SceneReport> scenes;
  std::vector<ContactCurve> contact_curves;
  RoundingReport rounding;
  std::string machine, date;
  std::string estimate; /* what was said of the time before it started */

  size_t unequal() const; /* runs that do not end in the bits of the backend that was observed */
};

/* InputError for what a user got wrong. Says first on standard error how long it will take, and shows a progress
 * bar. */
Report collect_report(const ReportRequest &request);

/* Scenes with all their runs, in the request's order; what collect_report does of it, without a word. */
std::vector<SceneReport> collect_scenes(const ReportRequest &request);

/* Marks the runs on the Pareto front of cost against `metric`, and finds what to pick; wishes finer than `uncertainty`
 * are left out. */
std::vector<Pick> pick_settings(std::vector<Run> &runs, Metric metric, double uncertainty);

/* "For a position error of at most 1 mm take pgs with 1 substep, 8 iterations (0.12 ms for 1/60 s); for ..." */
std::string pick_sentence(const std::vector<Run> &runs, const std::vector<Pick> &picks, Metric metric);

/* The `tandem run` line that repeats a run's simulation and time. */
std::string run_command_of(const SceneReport &scene, const Run &run);

} // namespace tandem
