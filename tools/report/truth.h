/* truth.h - where the bodies of a scene really go: the reference backend in double at a small fraction of the time
 * step.
 *
 *   frames of 1/30 s     0 ....... 1 ....... 2 .... T       at each the states of all bodies
 *   closed form          where there is one it replaces the simulated positions, and the reference is measured against
 *                        it
 *   refinement           r / 4, r / 2 and r steps for each 1/60 s: how far the truth itself is known, and its order
 *   horizon              two runs whose starts differ in one coordinate of one body by 1e-9 m, or by one ulp where
 *                        floats are coarser: past the time at which some body is 1000 times as far apart, trajectories
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
  /* Impacts fall into other steps at other time steps; where the two finest runs part (RMS of resolved_bound), the
   * truth is not known. */
  bool resolved = true;
  size_t comparable_frames = 0; /* frames up to the horizon, and resolved */
  bool closed_form = false;
  bool known() const { return !frames.empty(); } /* false where a scene is judged without: by penetration, say */

  /* RMS distance of the reference from the truth over the comparable frames, at r / 4, r / 2 and r steps for each 1/60
   * s: from the closed form where there is one, else from the finest (the last is then 0). */
  uint32_t refinements[3] = {};
  TrajectoryError refinement_errors[3];
  std::optional<double> order; /* of convergence; nothing if the runs agree to rounding */

  double uncertainty_position() const { return closed_form ? 0 : refinement_errors[1].position_rms(); }
  double uncertainty_rotation() const { return refinement_errors[1].angle_rms(); }
};

/* On one thread: its runs go side by side. */
inline constexpr const char *truth_backend = "reference:threads=1";

/* Settings of the reference: one substep, many iterations, contacts as rigid as the step allows, no penetration left in
 * place. */
Settings truth_settings(uint32_t refinement);

/* `refinement`: a power of two, at least 8. Its four runs go at once on as many threads. */
Truth find_truth(const Scene &scene, double duration, uint32_t refinement);

inline size_t frames_in(double duration) { return static_cast<size_t>(duration / frame_time + 0.5); }

} // namespace tandem
