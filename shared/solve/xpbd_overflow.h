/* xpbd_overflow.h - the passes of xpbd.h over the constraints past the last colour, in order by one item; see
 * overflow.h. */
#ifndef TANDEM_SHARED_SOLVE_XPBD_OVERFLOW_H
#define TANDEM_SHARED_SOLVE_XPBD_OVERFLOW_H

#include "shared/solve/overflow.h"
#include "shared/solve/xpbd.h"

SHARED void xpbd_positions_overflow_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                         read_patches patches, GLOBAL const float4 *constraint_slip,
                                         GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                                         GLOBAL const uint *counts, write_contact_impulses contact_impulses,
                                         GLOBAL float4 *solver_velocity, uint first_iteration, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_CONSTRAINT(i)
  xpbd_positions_item(parameters, contacts, patches, constraint_slip, solver_inertia, solver_delta_pose, counts,
                      contact_impulses, solver_velocity, first_iteration, i);
}

SHARED void xpbd_velocities_overflow_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                          read_patches patches, GLOBAL const float4 *solver_inertia,
                                          GLOBAL const float4 *solver_delta_pose, GLOBAL const uint *counts,
                                          GLOBAL float4 *constraint_normal_impulse,
                                          GLOBAL float4 *constraint_friction_impulse, GLOBAL float4 *solver_velocity,
                                          uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_CONSTRAINT(i)
  xpbd_velocities_item(parameters, contacts, patches, solver_inertia, solver_delta_pose, counts,
                       constraint_normal_impulse, constraint_friction_impulse, solver_velocity, i);
}

#endif
