/* cases_spin.cpp - the group of cases of fast and unstable rotation, compared with conservation laws and the theory of
 * the free and the heavy top. */
#include <cmath>
#include <memory>

#include "host/catalog/structures.h"
#include "tools/stability/cases.h"
#include "tools/stability/flip.h"

namespace tandem::stability {
namespace {

/* A free rod of 1 m by 4 cm that rotates mostly about body axis `axis` at `speed`, with a hundredth of it about the
 * other axes. */
Trial rod_trial(int axis, double speed, double energy, Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 600, 600));
  Body &rod = add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.02f, 0.02f), {0, 0, 0});
  for (int k = 0; k < 3; ++k) rod.angular_velocity[size_t(k)] = float(k == axis ? speed : 0.01 * speed);
  trial.checks.push_back(check("drift of angular momentum", "", 4e-3, spin_momentum_drift(0)));
  trial.checks.push_back(check("drift of energy", "", energy, spin_energy_drift(0)));
  return trial;
}

/* A plate of three different moments that rotates about the middle axis and flips repeatedly (Dzhanibekov). */
struct FlipBounds {
  double time, momentum, energy;
};

Trial flip_trial(double speed, const FlipBounds &bounds, Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 1800, 1800));
  const double slant = 0.02;
  Body &plate = add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.1f), {0, 0, 0});
  plate.angular_velocity = {float(speed * slant), float(speed), 0};
  const double interval = flip_interval(moments_of(trial.scene, plate), vector_of(plate.angular_velocity));
  trial.checks.push_back(at_end(check("error of the time between flips", "", bounds.time, flip_error(0, interval))));
  trial.checks.push_back(check("drift of angular momentum", "", bounds.momentum, spin_momentum_drift(0)));
  trial.checks.push_back(check("drift of energy", "", bounds.energy, spin_energy_drift(0)));
  return trial;
}

/* The error of the azimuth of the line from tip to centre, unwrapped, against W t; the tip is where the corner touches
 * the ground. */
Figure precession_error(double rate)
{
  struct Azimuth {
    double before = 0, turned = 0, first_time = -1;
  };
  auto azimuth = std::make_shared<Azimuth>();
  return [=](const Moment &moment) {
    const Vector axis = axes_of(moment.bodies[1].orientation) * Vector(1, 1, 1);
    const double now = std::atan2(-axis.z(), axis.x());
    if (azimuth->first_time < 0) azimuth->first_time = moment.time;
    else azimuth->turned += std::remainder(now - azimuth->before, 2 * pi);
    azimuth->before = now;
    const double expected = rate * (moment.time - azimuth->first_time);
    return expected > 1 ? std::abs(azimuth->turned / expected - 1) : 0.0;
  };
}

/* The change of the lean since the start, which steady precession keeps constant. */
Figure nutation(const Scene &scene)
{
  const double start = std::acos((axes_of(scene.bodies[1].orientation) * Vector(1, 1, 1).normalized()).y());
  return [start](const Moment &moment) {
    return std::abs(std::acos((axes_of(moment.bodies[1].orientation) * Vector(1, 1, 1).normalized()).y()) - start);
  };
}

Trial top_trial(Length length)
{
  Trial trial = trial_of(load_scene("tops"), steps_for(length, 5000, 5000));
  trial.settings.step = 1e-3f;
  trial.every = 20;
  trial.documented = trial.settings;
  trial.documented->slop = 1e-4f; /* a top that has sunk by 5 mm precesses about another point than its corner */
  const double rate = steady_precession(0.1, 100, 0.3, 10);
  trial.checks.push_back(at_end(check("error of the precession's angle", "", 0.01, precession_error(rate))));
  trial.checks.push_back(check("change of the lean", "rad", 0.05, nutation(trial.scene)));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

} // namespace

void add_spin_cases(std::vector<Case> &cases)
{
  const char *conserved = "angular momentum drifts by less than 0.4% and energy by less than 0.02% in 10 s";
  cases.push_back({"rod-across-100", "spin", "a free rod end over end at 100 rad/s", conserved,
                   [](Length length) { return rod_trial(1, 100, 8e-5, length); }});
  cases.push_back({"rod-across-1000", "spin", "a free rod end over end at 1,000 rad/s: four radians a substep",
                   conserved, [](Length length) { return rod_trial(1, 1000, 4e-5, length); }});
  cases.push_back({"rod-along-1000", "spin", "a free rod about its long axis at 1,000 rad/s, wobbling", conserved,
                   [](Length length) { return rod_trial(0, 1000, 2e-4, length); }});
  const char *flips = "time between flips within 0.15% of theory (elliptic integral), 3e-5 at 4 rad/s; momentum drifts "
                      "by less than 6e-5, energy by less than 0.1% in 30 s";
  cases.push_back({"flip", "spin", "a free plate that turns about its middle axis at 4 rad/s and flips over and over",
                   flips, [](Length length) {
                     return flip_trial(4, {3e-5, 6e-5, 1e-4}, length);
                   }});
  cases.push_back(
      {"flip-fast", "spin", "the same at 30 rad/s, an eighth of a radian a substep", flips, [](Length length) {
         return flip_trial(30, {1.5e-3, 7e-5, 1e-3}, length);
       }});
  cases.push_back({"top", "spin",
                   "a cube of 20 cm that spins on a corner at 100 rad/s and precesses; at dt 1/1000, since it turns "
                   "1.7 rad in 1/60 s and contacts are found once a step",
                   "angle of precession within 1% of the steady precession of a heavy symmetric top, lean kept to 0.05 "
                   "rad, no gain of energy, 5 s",
                   top_trial});
}

} // namespace tandem::stability
