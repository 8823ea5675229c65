/* results.h - the results of a run of the cases, and their JSON, CSV and page. */
#pragma once

#include "tools/command/output.h"
#include "tools/stability/trial.h"

namespace tandem::stability {

struct Result {
  Case which;
  Outcome outcome;
  std::vector<Body> start; /* for the pictures, with the shapes */
  std::vector<Shape> shapes;
  size_t place = 0; /* index among all runs */
};

struct Results {
  std::string backend;
  std::vector<std::string> solvers; /* the default first, if it ran */
  Length length;
  std::vector<Result> results; /* by index: case by case, within each solver by solver */
  size_t expected = 0;         /* the number of runs in total; 0: as many as there are */
  size_t at_once = 1;          /* parallel runs, which slow each other */

  void add(const Case &which, const Scene &scene, Outcome outcome, size_t place);
  bool complete() const { return results.size() >= expected; }
  double total_milliseconds() const; /* of all runs, as if one after the other */
};

/* A figure with its unit, such as "0.0087 m". */
std::string with_unit(double figure, const std::string &unit);

/* "complete" is false while runs are missing. */
Json results_json(const Results &results);
/* The page: a table of cases by solvers, then each case with its pictures and its figure over time. `command` is the
 * command line that made it. */
std::string results_page(const Results &results, const std::string &command);
/* Every figure over time: case, solver, figure, unit, time, value. */
std::string series_csv(const Results &results);

} // namespace tandem::stability
