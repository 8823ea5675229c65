/* prepare.h - copies of the bodies for the solver: velocity, inverse inertia in world axes, motion so far.
 *
 * The step works on these copies and only the commit stage writes the state, so a step that overflows or fails leaves
 * the state unchanged and can be run again.
 */
#ifndef TANDEM_SHARED_INTEGRATE_PREPARE_H
#define TANDEM_SHARED_INTEGRATE_PREPARE_H

#include "shared/argument_groups.h"
#include "shared/records.h"

/* Records the first body that is not finite, in pipeline order and then by index. */
SHARED void note_nonfinite(mask finite, GLOBAL uint *counts, uint_lanes body, uint stage)
{
  mask bad = !finite;
  if (any_of(bad)) atomic_min_if(bad, counts, COUNT_NONFINITE, body | (uint_lanes)(stage << 28u));
}

SHARED mask quaternion_is_finite(vec4 q) { return is_finite(xyz(q)) & is_finite(make_vec3(q.w, q.w, q.w)); }

SHARED mask velocity_is_finite(spatial_velocity m) { return is_finite(m.linear) & is_finite(m.angular); }

SHARED mask state_is_finite(read_bodies bodies, item_index i)
{
  double_float3 position = load_position(bodies.position, i);
  return velocity_is_finite(load_velocity(bodies.velocity, i)) & is_finite(position.high) & is_finite(position.low) &
         quaternion_is_finite(load_float4(bodies.orientation, i));
}

SHARED void prepare_bodies_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass, read_bodies bodies,
                                GLOBAL uint *counts, GLOBAL float4 *solver_velocity, GLOBAL float4 *solver_delta_pose,
                                GLOBAL float4 *solver_inertia, GLOBAL float4 *solver_orientation,
                                write_colored_bodies colored_bodies, GLOBAL uint *body_falls, item_index i)
{
  spatial_velocity m = load_velocity(bodies.velocity, i);
  vec4 orientation = load_float4(bodies.orientation, i);
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  note_nonfinite(state_is_finite(bodies, i), counts, i, NONFINITE_AT_START);
  vec3 inverse_moments = xyz(load_float4(body_mass, i));
  m.inverse_inertia = inverse_moments.x;
  store_velocity(solver_velocity, i, m);
  store_float4(solver_delta_pose, i * 2u, zero);
  store_float4(solver_delta_pose, i * 2u + 1u, zero);
  if (HAS_FEATURE(parameters, GYROSCOPIC))
    store_inertia(solver_inertia, i, inertia_of(quat_from(orientation), inverse_moments));
  store_float4(solver_orientation, i, orientation);
  store_uint(colored_bodies.colors, i * 2u, 0u);
  store_uint(colored_bodies.colors, i * 2u + 1u, 0u);
  store_uint(colored_bodies.bid, i * 2u, 0u);
  store_uint(colored_bodies.bid, i * 2u + 1u, 0u);
  store_uint(body_falls, i, 1u);
}

#endif
