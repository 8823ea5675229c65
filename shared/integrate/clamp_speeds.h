/* clamp_speeds.h - no body enters a substep faster than its highest speeds (Body::max_linear_speed, max_angular_speed).
 *
 * It runs after gravity, damping and the warm start, so contacts of the substep can still make a body faster until the
 * next one. The direction stays.
 */
#ifndef TANDEM_SHARED_INTEGRATE_CLAMP_SPEEDS_H
#define TANDEM_SHARED_INTEGRATE_CLAMP_SPEEDS_H

#include "shared/substep_classes.h"

/* limit: may be infinite. */
SHARED vec3 at_most_this_fast(vec3 v, real limit)
{
  real speed = length_of(v);
  mask fast = speed > limit;
  return choose3(fast, scale(v, choose(fast, limit, (real)R(1.0)) / choose(fast, speed, (real)R(1.0))), v);
}

SHARED void clamp_speeds_item(GLOBAL const Parameters *parameters, GLOBAL const memory_real *body_max_speed,
                              GLOBAL const uint *body_class, GLOBAL float4 *solver_velocity, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  m.linear = at_most_this_fast(m.linear, load_real(body_max_speed, i * 2u));
  m.angular = at_most_this_fast(m.angular, load_real(body_max_speed, i * 2u + 1u));
  store_velocity_if(moved_among(parameters, body_class, m.inverse_mass > R(0.0), i), solver_velocity, i, m);
}

#endif
