/* estimate.h - estimates how long a report will take, from a few steps of every solver on every backend and of the
 * reference.
 *
 * Steps are timed from the middle of the scene, because at the start bodies may not touch yet. The same figures weigh
 * the progress bar, and select the backend on which the errors of a scene are computed: the fastest.
 */
#pragma once

#include <string>
#include <vector>

#include "tools/report/cases.h"
#include "tools/report/truth.h"

namespace tandem {

struct SceneEstimate {
  std::vector<std::string> backends, solvers;
  std::vector<std::vector<double>>
      step_milliseconds; /* [backend][solver], at the solver's default settings; 0 if it failed */
  double truth_seconds = 0,
         longest_truth_seconds = 0; /* all runs of the reference one after the other, and the longest of them */

  /* The estimated time of one run of this length, in s. */
  double run_seconds(size_t backend, const Settings &settings, double duration) const;
  size_t fastest_backend() const; /* over all solvers */
};

/* refinement 0: the scene needs no reference solution. */
SceneEstimate estimate_scene(const Scene &scene, double duration, uint32_t refinement,
                             const std::vector<std::string> &backends, const std::vector<std::string> &solvers);

/* "40 s", "7 min" */
std::string duration_text(double seconds);

} // namespace tandem
