/* xpbd_tail.h - the passes of xpbd.h over the constraints past the last colour, in order by one item; see tail.h. */
#ifndef TANDEM_SHARED_SOLVE_XPBD_TAIL_H
#define TANDEM_SHARED_SOLVE_XPBD_TAIL_H

#include "shared/solve/tail.h"
#include "shared/solve/xpbd.h"

SHARED void xpbd_positions_tail_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a,
                                     GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                     GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                                     GLOBAL const row *constraint_slip, GLOBAL const row *solver_inertia,
                                     GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                     GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_friction_impulse,
                                     GLOBAL row *constraint_bounce, GLOBAL row *solver_velocity, uint first_iteration,
                                     uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  xpbd_positions_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                      constraint_slip, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                      constraint_friction_impulse, constraint_bounce, solver_velocity, first_iteration, i);
}

SHARED void xpbd_velocities_tail_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a,
                                      GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                      GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                                      GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                      GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse,
                                      GLOBAL row *constraint_friction_impulse, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  xpbd_velocities_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                       solver_inertia, solver_delta, counts, constraint_normal_impulse, constraint_friction_impulse,
                       solver_velocity, i);
}

#endif
