/* experiment.cpp - runs a scene, times its steps and computes its errors frame by frame; see experiment.h. */
#include "tools/report/experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "tools/command/measure.h"

namespace tandem {
namespace {

using Array = std::array<double, 3>;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double norm(const Array &v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
Array minus(const Array &a, const Array &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

bool only_gravity_acts(const Scene &scene)
{
  return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body &body) { return body.type == BodyType::dynamic; });
}

/* Steps of all grids divide a frame of 1/30 s evenly. */
uint64_t steps_in_frame(const Settings &settings)
{
  return static_cast<uint64_t>(std::llround(frame_time / double{settings.step}));
}

/* The errors accumulated over the frames of a run. */
class Observation {
public:
  Observation(const Scene &scene, const Truth &truth) : scene_(scene), truth_(truth) {}

  void frame(World &world, size_t k)
  {
    last_ = world.precise_bodies();
    if (k < truth_.comparable_frames) trajectory_.add(scene_, last_, truth_.frames[k]);
    const StepResiduals residuals = step_residuals(world);
    natural_map_ += residuals.natural_map;
    fischer_burmeister_ += residuals.fischer_burmeister;
    cone_violation_ = std::max(cone_violation_, residuals.cone_violation);
    ++frames_;
  }

  void write(Run &run, const Statistics &statistics) const
  {
    const auto set = [&](Metric metric, double value) { run.errors[static_cast<size_t>(metric)] = value; };
    const double count = std::max<double>(static_cast<double>(frames_), 1);
    const bool comparable = truth_.comparable_frames > 0;
    set(Metric::position, comparable ? trajectory_.position_rms() : undefined);
    set(Metric::rotation, comparable ? trajectory_.angle_rms() : undefined);
    run.position_max = comparable ? trajectory_.position_max() : undefined;
    run.rotation_max = comparable ? trajectory_.angle_max() : undefined;
    set(Metric::max_penetration, statistics.max_penetration);
    set(Metric::mean_penetration, statistics.mean_penetration);
    set(Metric::natural_map, natural_map_ / count);
    set(Metric::fischer_burmeister, fischer_burmeister_ / count);
    set(Metric::cone_violation, cone_violation_);
    run.mean_height_error = undefined;
    if (truth_.known()) {
      const PreciseBodies &end = truth_.frames[frames_ - 1];
      set(Metric::energy,
          std::abs(conserved_quantities(scene_, last_).energy() - conserved_quantities(scene_, end).energy()));
      run.mean_height_error = std::abs(mean_height(scene_, last_) - mean_height(scene_, end));
    }
    write_drift(run);
  }

private:
  /* Gravity changes momentum by M g t, which is known, and angular momentum about the origin by a torque that depends
   * on the path. Angular momentum is therefore taken about the common centre of mass. */
  void write_drift(Run &run) const
  {
    run.momentum_drift = run.angular_momentum_drift = undefined;
    if (!only_gravity_acts(scene_)) return;
    const double time = static_cast<double>(frames_) * frame_time;
    const auto [start_momentum, start_spin] = about_center(start_states());
    const auto [momentum, spin] = about_center(last_);
    double mass = 0;
    for (const Body &body : scene_.bodies) mass += double{body.mass};
    Array expected = start_momentum;
    for (int k = 0; k < 3; ++k) expected[k] += mass * double{scene_.gravity[k]} * time;
    run.momentum_drift = norm(minus(momentum, expected)) / std::max(norm(expected), 1e-30);
    run.angular_momentum_drift = norm(minus(spin, start_spin)) / std::max(norm(start_spin), 1e-30);
  }

  PreciseBodies start_states() const
  {
    PreciseBodies states;
    for (const Body &body : scene_.bodies) {
      PreciseBodyState state{};
      std::copy(body.position.begin(), body.position.end(), state.position.begin());
      std::copy(body.orientation.begin(), body.orientation.end(), state.orientation.begin());
      std::copy(body.linear_velocity.begin(), body.linear_velocity.end(), state.linear_velocity.begin());
      std::copy(body.angular_velocity.begin(), body.angular_velocity.end(), state.angular_velocity.begin());
      states.push_back(state);
    }
    return states;
  }

  /* Momentum, and angular momentum about the common centre of mass, to which the bodies are translated. */
  std::pair<Array, Array> about_center(PreciseBodies states) const
  {
    Array center{};
    double mass = 0;
    for (size_t i = 0; i < states.size(); ++i) {
      mass += double{scene_.bodies[i].mass};
      for (int k = 0; k < 3; ++k) center[k] += double{scene_.bodies[i].mass} * states[i].position[k];
    }
    for (PreciseBodyState &state : states)
      for (int k = 0; k < 3; ++k) state.position[k] -= center[k] / mass;
    const Conserved sum = conserved_quantities(scene_, states);
    return {sum.momentum, sum.angular_momentum};
  }

  const Scene &scene_;
  const Truth &truth_;
  TrajectoryError trajectory_;
  PreciseBodies last_;
  size_t frames_ = 0;
  double natural_map_ = 0, fischer_burmeister_ = 0, cone_violation_ = 0;
};

/* Called after each frame, outside of the timed spans. */
using AfterFrame = std::function<void(World &, size_t frame)>;

void simulate(Run &run, World &world, double duration, const AfterFrame &after_frame)
{
  const uint64_t in_frame = steps_in_frame(run.settings);
  const size_t frames = frames_in(duration);
  run.steps = in_frame * frames;
  std::vector<double> milliseconds;
  for (size_t k = 0; k < frames; ++k) {
    for (uint64_t step = 0; step < in_frame; ++step) milliseconds.push_back(timed_step(world));
    if (after_frame) after_frame(world, k);
  }
  milliseconds.erase(milliseconds.begin(), milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 4));
  run.step_milliseconds = spread_of(milliseconds).median;
  run.hash = world.body_hash();
}

void observe(Run &run, const Scene &scene, double duration, const Truth &truth)
{
  World world(scene, run.settings, Placement{run.backend, {}, false});
  keep_residuals(world);
  Observation observation(scene, truth);
  simulate(run, world, duration, [&](World &, size_t k) { observation.frame(world, k); });
  const Statistics statistics = world.statistics();
  run.quarantined = statistics.nonfinite;
  run.observed_on = run.backend;
  observation.write(run, statistics);
}

Run empty_run(const Settings &settings, const std::string &backend)
{
  Run run;
  run.solver = name_of(settings.solver);
  run.backend = backend;
  run.settings = settings;
  run.errors.fill(undefined);
  run.position_max = run.rotation_max = run.mean_height_error = run.momentum_drift = run.angular_momentum_drift =
      undefined;
  return run;
}

/* A failing simulation is a result of the report; an error of the user is not, and is thrown. */
void run_or_fail(Run &run, const std::function<void()> &run_it)
{
  try {
    run_it();
  } catch (const InputError &) {
    throw;
  } catch (const std::exception &error) {
    run.failure = error.what();
  }
}

/* Copies the errors of another run; time, backend and front stay its own. */
void take_errors(Run &run, const Run &observed)
{
  run.errors = observed.errors;
  run.position_max = observed.position_max;
  run.rotation_max = observed.rotation_max;
  run.mean_height_error = observed.mean_height_error;
  run.momentum_drift = observed.momentum_drift;
  run.angular_momentum_drift = observed.angular_momentum_drift;
  run.quarantined = observed.quarantined;
  run.observed_on = observed.observed_on;
}

bool in_double(const std::string &backend) { return backend.starts_with("reference"); }

} // namespace

Run run_experiment(const Scene &scene, double duration, const Truth &truth, const Settings &settings,
                   const std::string &backend)
{
  Run run = empty_run(settings, backend);
  run_or_fail(run, [&] { observe(run, scene, duration, truth); });
  return run;
}

Run time_experiment(const Scene &scene, double duration, const Truth &truth, const Run &observed,
                    const std::string &backend)
{
  if (in_double(backend) || in_double(observed.backend) || !observed.failure.empty())
    return run_experiment(scene, duration, truth, observed.settings, backend);
  Run run = empty_run(observed.settings, backend);
  run_or_fail(run, [&] {
    World world(scene, run.settings, Placement{backend, {}, false});
    simulate(run, world, duration, {});
    run.unequal = run.hash != observed.hash;
    if (!run.unequal) take_errors(run, observed);
    else
      run.failure =
          fmt::format("ends with hash {:016x}, on {} with {:016x}", run.hash, observed.backend, observed.hash);
  });
  return run;
}

} // namespace tandem
