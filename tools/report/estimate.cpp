/* estimate.cpp - times a few steps from the middle of a scene and extrapolates; see estimate.h. */
#include "tools/report/estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "tools/command/measure.h"

namespace tandem {
namespace {

constexpr int timed_steps = 2;

/* The time of a step in ms. The first step, which sizes buffers and builds kernels, is omitted. The result is 0 if the
 * simulation fails, which the run itself will report. */
double step_time(const Scene &scene, const Settings &settings, const std::string &backend)
{
  try {
    World world(scene, settings, Placement{backend, {}, false});
    world.step();
    std::vector<double> milliseconds;
    for (int k = 0; k < timed_steps; ++k) milliseconds.push_back(timed_step(world));
    return spread_of(milliseconds).minimum;
  } catch (const InputError &) {
    throw;
  } catch (const std::exception &) {
    return 0;
  }
}

Scene at_half_time(Scene scene, double duration, const std::string &backend)
{
  World world(scene, Settings{}, Placement{backend, {}, false});
  for (size_t step = 0; step < frames_in(duration); ++step) world.step(); /* half a frame each */
  const std::vector<BodyState> states = world.bodies();
  if (world.statistics().nonfinite > 0) return scene;
  for (size_t i = 0; i < states.size(); ++i) {
    scene.bodies[i].position = states[i].position;
    scene.bodies[i].orientation = states[i].orientation;
    scene.bodies[i].linear_velocity = states[i].linear_velocity;
    scene.bodies[i].angular_velocity = states[i].angular_velocity;
  }
  return scene;
}

} // namespace

double SceneEstimate::run_seconds(size_t backend, const Settings &settings, double duration) const
{
  const Settings own = settings_for(settings.solver);
  const double passes = double(settings.substeps) * settings.iterations / (double(own.substeps) * own.iterations);
  const auto solver =
      static_cast<size_t>(std::find(solvers.begin(), solvers.end(), name_of(settings.solver)) - solvers.begin());
  const double steps = duration / double{settings.step},
               beside_passes = 0.3; /* share of a step that does not grow with the passes */
  return 1e-3 * steps * step_milliseconds[backend][solver] * (beside_passes + (1 - beside_passes) * passes);
}

size_t SceneEstimate::fastest_backend() const
{
  const auto total = [](const std::vector<double> &times) { return std::accumulate(times.begin(), times.end(), 0.0); };
  return static_cast<size_t>(std::min_element(step_milliseconds.begin(), step_milliseconds.end(),
                                              [&](const auto &a, const auto &b) { return total(a) < total(b); }) -
                             step_milliseconds.begin());
}

SceneEstimate estimate_scene(const Scene &scene, double duration, uint32_t refinement,
                             const std::vector<std::string> &backends, const std::vector<std::string> &solvers)
{
  SceneEstimate estimate{backends, solvers, {}, 0, 0};
  const Scene middle = at_half_time(scene, duration, backends.front());
  for (const std::string &backend : backends) {
    estimate.step_milliseconds.emplace_back();
    for (const std::string &solver : solvers)
      estimate.step_milliseconds.back().push_back(
          step_time(middle, settings_for(parse_setting<Solver>(solver)), backend));
  }
  if (refinement == 0) return estimate;
  const double steps = 2.0 * refinement * static_cast<double>(frames_in(duration));
  estimate.longest_truth_seconds = 1e-3 * steps * step_time(middle, truth_settings(refinement), truth_backend);
  estimate.truth_seconds = 2 * estimate.longest_truth_seconds; /* and at 1/2, 1/4 and 1/4 of its steps */
  return estimate;
}

std::string duration_text(double seconds)
{
  if (seconds < 100) return fmt::format("{:.0f} s", std::max(1.0, std::ceil(seconds)));
  return fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

} // namespace tandem
