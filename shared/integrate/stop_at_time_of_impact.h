/* stop_at_time_of_impact.h - cuts a body's motion to the fraction that narrowphase/clamp_to_time_of_impact.h found free
 * of walls.
 *
 * An uneven body keeps its spin in its own axes, as it is at the end of the whole motion, and with it its energy. The
 * same spin in world axes would be one about another of its axes: a thin rod has a thousand times the energy if it
 * turns across its length and not about it. */
#ifndef TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H
#define TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H

#include "shared/integrate/positions.h"
#include "shared/locks.h"

SHARED vec3 turned_with_body(vec3 spin, quat from, quat to)
{
  return rotate(rotation_of(to), rotate_back(rotation_of(from), spin));
}

/* body_toi_fraction: the fraction of the motion that is kept, in 1 / 2^24. */
SHARED void stop_at_time_of_impact_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass,
                                        GLOBAL const uint *body_lock, GLOBAL const float4 *body_orientation,
                                        GLOBAL const uint *body_toi_fraction, GLOBAL float4 *solver_velocity,
                                        GLOBAL float4 *solver_delta_pose, GLOBAL float4 *solver_orientation,
                                        item_index i)
{
  real share = to_real(load_uint(body_toi_fraction, i)) * R(5.9604644775390625e-8);
  mask cut = share < R(1.0);
  if (!any_of(cut)) return;
  vec3 translation = scale(xyz(load_float4(solver_delta_pose, i * 2u)), share),
       rotation = scale(xyz(load_float4(solver_delta_pose, i * 2u + 1u)), share);
  quat stopped = turned(quat_from(load_float4(body_orientation, i)), rotation);
  if (HAS_FEATURE(parameters, GYROSCOPIC)) {
    /* What holds an axis keeps the spin about the others in world axes. */
    uint_lanes locks = HAS_FEATURE(parameters, LOCKS) ? load_uint(body_lock, i) : (uint_lanes)0u;
    spatial_velocity m = load_velocity(solver_velocity, i);
    mask turns = cut & is_uneven(m, load_float4(body_mass, i)) & (angular_locks(locks) == 0u);
    m.angular = turned_with_body(m.angular, quat_from(load_float4(solver_orientation, i)), stopped);
    store_velocity_if(turns, solver_velocity, i, m);
  }
  store_float4_if(cut, solver_delta_pose, i * 2u, extend(translation, R(0.0)));
  store_float4_if(cut, solver_delta_pose, i * 2u + 1u, extend(rotation, R(0.0)));
  store_float4_if(cut, solver_orientation, i, quat_to_vec4(stopped));
}

#endif
