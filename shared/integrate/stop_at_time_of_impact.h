/* stop_at_time_of_impact.h - cuts a body's motion to the fraction that narrowphase/clamp_to_time_of_impact.h found free
 * of walls.
 *
 * An uneven body keeps its spin in its own axes, as it is at the end of the whole motion, and with it its energy. The
 * same spin in world axes would be one about another of its axes: a thin rod has a thousand times the energy if it
 * turns across its length and not about it. A body that is held about an axis cannot turn its spin so: its spin keeps
 * its direction in world axes, and is slowed where it would have more energy than at the end of the whole motion. */
#ifndef TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H
#define TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H

#include "shared/integrate/positions.h"
#include "shared/locks.h"

SHARED vec3 turned_with_body(vec3 spin, quat from, quat to)
{
  return rotate(rotation_of(to), rotate_back(rotation_of(from), spin));
}

/* The moments about the body's axes, 0 where they are infinite. */
SHARED vec3 finite_moments(vec3 inverse_moments)
{
  return make_vec3(held_share(inverse_moments.x), held_share(inverse_moments.y), held_share(inverse_moments.z));
}

/* Twice the energy of a spin; an axis about which the body has no finite moment does not count. */
SHARED real energy_of_spin(quat orientation, vec3 moments, vec3 angular)
{
  vec3 own = rotate_back(rotation_of(orientation), angular);
  return dot3(multiply(own, own), moments);
}

/* What rounding makes of the energy of a spin about axes without a finite moment, as a share of what it would have
 * about the axis with the largest one. */
#define ROUNDING_OF_SPIN R(1e-8)

/* The factor that leaves a spin in world axes no more energy at one orientation than it had at another. */
SHARED real share_of_spin(quat from, quat to, vec3 inverse_moments, vec3 angular)
{
  vec3 moments = finite_moments(inverse_moments);
  real before = energy_of_spin(from, moments, angular), after = energy_of_spin(to, moments, angular);
  real most = length_squared(angular) * maximum(maximum(moments.x, moments.y), moments.z);
  mask grows = (after > before) & (after > ROUNDING_OF_SPIN * most);
  return choose(grows, square_root(before / choose(grows, after, (real)R(1.0))), (real)R(1.0));
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
    spatial_velocity m = load_velocity(solver_velocity, i);
    vec4 mass = load_float4(body_mass, i);
    mask uneven = cut & is_uneven(m, mass);
    quat whole = quat_from(load_float4(solver_orientation, i));
    vec3 spin = turned_with_body(m.angular, whole, stopped);
    if (HAS_FEATURE(parameters, LOCKS)) {
      mask held = angular_locks(load_uint(body_lock, i)) != 0u;
      spin = choose3(held, scale(m.angular, share_of_spin(whole, stopped, xyz(mass), m.angular)), spin);
    }
    m.angular = spin;
    store_velocity_if(uneven, solver_velocity, i, m);
  }
  store_float4_if(cut, solver_delta_pose, i * 2u, extend(translation, R(0.0)));
  store_float4_if(cut, solver_delta_pose, i * 2u + 1u, extend(rotation, R(0.0)));
  store_float4_if(cut, solver_orientation, i, quat_to_vec4(stopped));
}

#endif
