/* lock_bodies.h - takes locked axes out of the velocity and the inverse inertia that the solvers work on; see locks.h.
 *
 * It runs after prepare_bodies, and after integrate_positions where that has turned the inertia of uneven bodies. Only
 * bodies that can be pushed have locks.
 */
#ifndef TANDEM_SHARED_INTEGRATE_LOCK_BODIES_H
#define TANDEM_SHARED_INTEGRATE_LOCK_BODIES_H

#include "shared/substep_classes.h"

SHARED void lock_bodies_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_lock,
                             GLOBAL const uint *body_class, GLOBAL float4 *solver_velocity,
                             GLOBAL float4 *solver_inertia, item_index i)
{
  uint_lanes locks = load_uint(body_lock, i);
  spatial_velocity m = load_velocity(solver_velocity, i);
  mask locked = moved_among(parameters, body_class, (locks != 0u) & (m.inverse_mass > R(0.0)), i);
  if (!any_of(locked)) return;
  m.linear = without_locked_axes(m.linear, linear_locks(locks));
  m.angular = without_locked_axes(m.angular, angular_locks(locks));
  symmetric3 s = held_about_axes(load_tensor(solver_inertia, i), angular_locks(locks));
  store_velocity_if(locked, solver_velocity, i, m);
  store_float4_if(locked, solver_inertia, i * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_float4_if(locked, solver_inertia, i * 2u + 1u, make_vec4(s.xz, s.yz, to_real(linear_locks(locks)), R(0.0)));
}

#endif
