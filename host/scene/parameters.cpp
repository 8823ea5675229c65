/* parameters.cpp - computes soft contact coefficients and margins; see parameters.h. */
#include "host/scene/parameters.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

namespace tandem {
namespace {

struct SoftContact {
  float rate, mass_scale, impulse_scale;
};

/* A mass on a spring and damper of the given frequency and damping ratio, integrated implicitly over one
 * substep, as coefficients of a velocity constraint (Catto, "Soft Constraints", GDC 2011). */
SoftContact soft_contact(double hertz, double damping_ratio, double h)
{
  if (hertz == 0) return {0, 1, 0};
  const double omega = 2 * M_PI * hertz;
  const double a1 = 2 * damping_ratio + h * omega, a2 = h * omega * a1, a3 = 1 / (1 + a2);
  return {round_to_float(omega / a1), round_to_float(a2 * a3), round_to_float(a3)};
}

/* Cells of two-stage batching are four bodies wide. If sizes are much alike, that is more than two of the largest body,
 * so cells of one class share no body; and a cell holds few enough contacts that one work-group can process it. */
float inverse_batch_cell(float median)
{
  const float edge = 8 * median;
  return edge > 0 ? 1 / edge : 1.0f;
}

/* What bodies come nearer at usual speeds in a step: 4 slop in 1/60 s. Shorter steps need less, and each contact that
 * no body reaches costs as much as another. Longer ones get no more, because the narrowphase adds what bodies close at
 * greater speeds. */
float speculative_distance(const Settings &settings)
{
  const double steps_of_60_hertz = std::min(60.0 * static_cast<double>(settings.step), 1.0);
  return settings.slop * round_to_float(std::max(4 * steps_of_60_hertz, 1.0));
}

/* At least one, and few enough that a count of them cannot overflow. */
uint32_t sleep_steps(const Settings &settings)
{
  return static_cast<uint32_t>(std::clamp(std::ceil(settings.sleep_time / settings.step), 1.0f, 1e9f));
}

/* By a square root, which every library rounds alike. */
float length_of(const Vec3 &v)
{
  double squared = 0;
  for (const float x : v) squared += static_cast<double>(x) * static_cast<double>(x);
  return round_to_float(std::sqrt(squared));
}

/* The solver xpbd closes in a substep what is open, as it does with contacts. */
SoftContact joint_softness(const Settings &settings, double h)
{
  if (settings.solver == Solver::xpbd) return {round_to_float(1 / h), 1, 0};
  return soft_contact(joint_hertz_of(settings), settings.joint_damping_ratio, h);
}

/* Stars of light bodies gained energy from 0.237 of the substep rate on (shared/joints/softness.h). Solvers that make
 * more passes a substep, or take only a part of the error of each joint, need no softer ones. */
SoftContact crowd_softness(const Settings &settings, double h)
{
  if (settings.solver != Solver::soft_step && settings.solver != Solver::direct) return joint_softness(settings, h);
  return soft_contact(std::min(joint_hertz_of(settings), 0.19 / h), settings.joint_damping_ratio, h);
}

} // namespace

Parameters parameters_of(const Scene &scene, const Settings &settings, Features features, float median)
{
  const double h = static_cast<double>(settings.step) / settings.substeps;
  /* Above a fifth of the substep rate, the bias raises bodies under load faster than the leak lets them sink, and tall
   * columns bounce. */
  const double hertz = std::min<double>(settings.contact_hertz, 0.2 / h);
  const SoftContact soft = soft_contact(hertz, settings.contact_damping_ratio, h);
  const SoftContact against_fixed = soft_contact(2 * hertz, settings.contact_damping_ratio, h);
  Parameters p{};
  p.step = settings.step;
  p.substep = round_to_float(h);
  p.inverse_substep = round_to_float(1 / h);
  p.gravity_x = scene.gravity[0];
  p.gravity_y = scene.gravity[1];
  p.gravity_z = scene.gravity[2];
  p.gravity_length = length_of(scene.gravity);
  p.warm_start_scale = 1;
  p.bias_rate = soft.rate;
  p.mass_scale = soft.mass_scale;
  p.impulse_scale = soft.impulse_scale;
  p.static_bias_rate = against_fixed.rate;
  p.static_mass_scale = against_fixed.mass_scale;
  p.static_impulse_scale = against_fixed.impulse_scale;
  const SoftContact joint = joint_softness(settings, h);
  p.joint_bias_rate = joint.rate;
  p.joint_mass_scale = joint.mass_scale;
  p.joint_impulse_scale = joint.impulse_scale;
  const SoftContact crowd = crowd_softness(settings, h);
  p.crowd_bias_rate = crowd.rate;
  p.crowd_impulse_scale = crowd.impulse_scale;
  p.push_speed = settings.push_speed;
  p.slop = settings.slop;
  p.slop_share = settings.slop_share;
  p.speculative_distance = speculative_distance(settings);
  p.bounds_margin = 0.5f * p.speculative_distance;
  p.restitution_speed = settings.restitution_speed;
  p.hybrid_cell = 4 * median;
  p.inverse_batch_cell = inverse_batch_cell(median);
  p.sleep_speed = settings.sleep_speed;
  p.sleep_steps = sleep_steps(settings);
  p.features = features;
  return p;
}

} // namespace tandem
