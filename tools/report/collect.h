/* collect.h - runs everything that a report shows. The results are plain data; report_page.cpp and data.cpp write
 * them. */
#pragma once

#include <string>
#include <vector>

#include "host/verify/rounding.h"
#include "tools/report/equal_error.h"
#include "tools/report/experiment.h"
#include "tools/report/joint_curves.h"
#include "tools/report/pareto.h"

namespace tandem {

struct ReportRequest {
  bool quick = false;
  std::vector<const ReportCase *> cases;
  std::vector<std::string> solvers;
  std::vector<std::string> backends; /* every scene runs on each; contact problems and joints on the first */
  std::optional<Metric> metric;      /* instead of each scene's own */
  std::vector<std::string> problems; /* files of contact problems */
  bool with_problems = true, with_joints = true, with_rounding = true;
  std::string command; /* as it was typed */
};

/* The setting to choose for a target error. */
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

  /* Errors below this are not significant, because the reference solution itself is not known more exactly. */
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
  JointReport joints;
  RoundingReport rounding;
  std::string machine, date;
  std::string estimate; /* the estimate that was printed before the start */

  size_t unequal() const; /* runs whose final bits differ from those of the backend on which errors were computed */
};

/* Throws InputError for bad input. Prints on standard error how long the report will take, and shows a progress bar. */
Report collect_report(const ReportRequest &request);

/* The part of collect_report that runs scenes, in the request's order, without any output. */
std::vector<SceneReport> collect_scenes(const ReportRequest &request);

/* Marks the runs on the Pareto front of cost against `metric`, and selects settings; targets finer than `uncertainty`
 * are omitted. */
std::vector<Pick> pick_settings(std::vector<Run> &runs, Metric metric, double uncertainty);

/* "For a position error of at most 1 mm take pgs with 1 substep, 8 iterations (0.12 ms for 1/60 s); for ..." */
std::string pick_sentence(const std::vector<Run> &runs, const std::vector<Pick> &picks, Metric metric);

/* The `tandem run` line that repeats a run's simulation and time. */
std::string run_command_of(const SceneReport &scene, const Run &run);

} // namespace tandem
