/* truth.h - the reference solution of a scene: the reference backend in double at a small fraction of the time step.
 *
 *   frames of 1/30 s     0 ....... 1 ....... 2 .... T       at each the states of all bodies
 *   closed form          where there is one it replaces the simulated positions, and the reference is compared with it
 *   refinement           r / 4, r / 2 and r steps for each 1/60 s: the uncertainty of the solution, and its order
 *   horizon              two runs whose starts differ in one coordinate of one body by 1e-9 m, or by one ulp where
 *                        floats are coarser: after the time at which some body is 1000 times as far apart, trajectories
 *                        of the scene are chaotic (Lyapunov) and not compared, only statistics are
 */
#pragma once

#include <optional>
#include <vector>

#include <tandem/metrics.h>

#include "tools/report/cases.h"

namespace tandem {

inline constexpr double least_nudge = 1e-9; /* m */
inline constexpr double horizon_growth = 1000;
inline constexpr double resolved_bound = 0.01; /* m */

/* Two time steps of 1/60 s, so that a step of 1/30 s can be compared too. */
inline constexpr double frame_time = 2 * double{base_step};

struct Truth {
  std::vector<PreciseBodies> frames; /* after 1, 2, ... frames */
  double nudge = 0;                  /* m, by which the start of the second run differed */
  double horizon = 0;                /* s; the duration if the two runs stay together */
  bool chaotic = false;              /* the horizon lies before the end */
  /* At different time steps impacts fall into different steps. If the two finest runs differ by more than an RMS of
   * resolved_bound, the solution is not known. */
  bool resolved = true;
  size_t comparable_frames = 0; /* frames up to the horizon, and resolved */
  bool closed_form = false;
  bool known() const { return !frames.empty(); } /* false if the scene has no reference solution */

  /* RMS distance over the comparable frames, at r / 4, r / 2 and r steps for each 1/60 s, from the closed form if there
   * is one, else from the finest run (the last distance is then 0). */
  uint32_t refinements[3] = {};
  TrajectoryError refinement_errors[3];
  std::optional<double> order; /* of convergence; nothing if the runs agree up to rounding */

  double uncertainty_position() const { return closed_form ? 0 : refinement_errors[1].position_rms(); }
  double uncertainty_rotation() const { return refinement_errors[1].angle_rms(); }
};

/* Each run has one thread, because the runs are executed in parallel. */
inline constexpr const char *truth_backend = "reference:threads=1";

/* Settings of the reference: one substep, many iterations, contacts as rigid as the step allows, no slop. */
Settings truth_settings(uint32_t refinement);

/* `refinement`: a power of two, at least 8. Its four runs are executed at once on as many threads. */
Truth find_truth(const Scene &scene, double duration, uint32_t refinement);

inline size_t frames_in(double duration) { return static_cast<size_t>(duration / frame_time + 0.5); }

} // namespace tandem
