/* truth.cpp - runs the reference at three refinements and from a perturbed start; see truth.h. */
#include "tools/report/truth.h"

#include <algorithm>
#include <cmath>

#include "host/catalog/closed_forms.h"
#include "tools/command/parallel.h"

namespace tandem {
namespace {

constexpr uint32_t converged_iterations = 30;

std::vector<PreciseBodies> run_reference(const Scene &scene, double duration, uint32_t refinement)
{
  World world(scene, truth_settings(refinement), Placement{truth_backend, {}, false});
  std::vector<PreciseBodies> frames;
  for (size_t k = 0; k < frames_in(duration); ++k) {
    for (uint32_t step = 0; step < 2 * refinement; ++step) world.step();
    frames.push_back(world.precise_bodies());
  }
  return frames;
}

/* Displaces the first dynamic body; returns the distance. */
double nudge(Scene &scene)
{
  for (Body &body : scene.bodies) {
    if (body.type != BodyType::dynamic) continue;
    const double before = body.position[0];
    body.position[0] += least_nudge;
    return body.position[0] - before;
  }
  return 0;
}

TrajectoryError error_of(const Scene &scene, const std::vector<PreciseBodies> &frames,
                         const std::vector<PreciseBodies> &truth, size_t count)
{
  TrajectoryError error;
  for (size_t k = 0; k < count; ++k) error.add(scene, frames[k], truth[k]);
  return error;
}

size_t frames_together(const Scene &scene, const std::vector<PreciseBodies> &one,
                       const std::vector<PreciseBodies> &other, double bound)
{
  for (size_t k = 0; k < one.size(); ++k) {
    TrajectoryError error;
    error.add(scene, one[k], other[k]);
    if (!(error.position_max() <= bound)) return k;
  }
  return one.size();
}

/* The number of frames for which two runs differ by at most `bound` in the mean. */
size_t frames_resolved(const Scene &scene, const std::vector<PreciseBodies> &one,
                       const std::vector<PreciseBodies> &other)
{
  for (size_t k = 0; k < one.size(); ++k) {
    TrajectoryError error;
    error.add(scene, one[k], other[k]);
    if (!(error.position_rms() <= resolved_bound)) return k;
  }
  return one.size();
}

/* Positions and velocities are replaced by the exact ones; orientations stay those of the reference, because a closed
 * form need not contain them. */
void take_closed_form(const Scene &scene, Truth &truth)
{
  for (size_t k = 0; k < truth.frames.size(); ++k) {
    const auto exact = closed_form_state(scene, static_cast<double>(k + 1) * frame_time);
    if (!exact) return;
    truth.closed_form = true;
    for (size_t i = 0; i < exact->size(); ++i) {
      truth.frames[k][i].position = (*exact)[i].position;
      truth.frames[k][i].linear_velocity = (*exact)[i].linear_velocity;
    }
  }
}

/* The order of convergence: from the errors of the two finest runs against the exact solution if it is known, else from
 * the differences of three runs, each with half the step. */
std::optional<double> order_of(const Scene &scene, const std::vector<PreciseBodies> (&runs)[3], const Truth &truth)
{
  const double rounding = 1e-11;
  const double exact_coarse = truth.refinement_errors[1].position_rms(),
               exact_fine = truth.refinement_errors[2].position_rms();
  if (truth.closed_form && exact_fine > rounding) return std::log2(exact_coarse / exact_fine);
  const auto apart = [&](const std::vector<PreciseBodies> &one, const std::vector<PreciseBodies> &other) {
    const TrajectoryError error = error_of(scene, one, other, truth.comparable_frames);
    return std::hypot(error.position_rms(), error.angle_rms());
  };
  const double coarse = apart(runs[0], runs[1]), fine = apart(runs[1], runs[2]);
  if (fine < rounding) return std::nullopt;
  return std::log2(coarse / fine);
}

} // namespace

Settings truth_settings(uint32_t refinement)
{
  Settings settings;
  settings.step = base_step / static_cast<float>(refinement);
  settings.substeps = 1;
  settings.iterations = converged_iterations;
  settings.slop = 1e-6f;
  settings.contact_hertz = 1e6f; /* limited to a quarter of the step rate */
  return settings;
}

Truth find_truth(const Scene &scene, double duration, uint32_t refinement)
{
  Truth truth;
  Scene nudged = scene;
  truth.nudge = nudge(nudged);
  std::vector<PreciseBodies> runs[3], beside;
  for (int k = 0; k < 3; ++k) truth.refinements[k] = refinement >> (2 - k);
  in_parallel(4, 4, [&](size_t k) { /* the longest first */
                                    if (k < 3) runs[2 - k] = run_reference(scene, duration, truth.refinements[2 - k]);
                                    else beside = run_reference(nudged, duration, truth.refinements[0]);
  });
  truth.frames = runs[2];
  truth.comparable_frames = frames_together(scene, runs[0], beside, horizon_growth * truth.nudge);
  truth.chaotic = truth.comparable_frames < truth.frames.size();
  const size_t resolved = frames_resolved(scene, runs[1], runs[2]);
  truth.horizon = truth.chaotic ? static_cast<double>(truth.comparable_frames) * frame_time : duration;
  take_closed_form(scene, truth);
  truth.resolved = truth.closed_form || resolved >= truth.comparable_frames;
  if (!truth.resolved) truth.comparable_frames = resolved;
  for (int k = 0; k < 3; ++k)
    truth.refinement_errors[k] = error_of(scene, runs[k], truth.frames, truth.comparable_frames);
  truth.order = order_of(scene, runs, truth);
  return truth;
}

} // namespace tandem
