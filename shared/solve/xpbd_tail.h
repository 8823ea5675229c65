/* xpbd_tail.h - the passes of xpbd.h over the constraints past the last colour, in order by one item; see tail.h. */
#ifndef TANDEM_SHARED_SOLVE_XPBD_TAIL_H
#define TANDEM_SHARED_SOLVE_XPBD_TAIL_H

#include "shared/solve/tail.h"
#include "shared/solve/xpbd.h"

SHARED void xpbd_positions_tail_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                     GLOBAL const row *constraint_slip, GLOBAL const row *solver_inertia,
                                     GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                     write_contact_impulses contact_impulses, GLOBAL row *solver_velocity,
                                     uint first_iteration, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  xpbd_positions_item(parameters, contacts, patches, constraint_slip, solver_inertia, solver_delta, counts,
                      contact_impulses, solver_velocity, first_iteration, i);
}

SHARED void xpbd_velocities_tail_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                      GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                      GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse,
                                      GLOBAL row *constraint_friction_impulse, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  xpbd_velocities_item(parameters, contacts, patches, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                       constraint_friction_impulse, solver_velocity, i);
}

#endif
