/* nncg_tail.h - nncg.h for constraints without a colour of their own, in order; see shared/solve/tail.h. */
#ifndef TANDEM_SHARED_SOLVE_NNCG_TAIL_H
#define TANDEM_SHARED_SOLVE_NNCG_TAIL_H

#include "shared/solve/nncg.h"
#include "shared/solve/tail.h"

SHARED void nncg_advance_tail_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                   GLOBAL const row *constraint_points, GLOBAL const row *constraint_center, GLOBAL const row *solver_inertia,
                                   GLOBAL const row *solver_delta, GLOBAL const memory_real *nncg_state, GLOBAL const uint *counts,
                                   GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_friction_impulse, GLOBAL row *nncg_impulse,
                                   GLOBAL row *nncg_direction, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  nncg_advance_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center, solver_inertia, solver_delta,
                    nncg_state, counts, constraint_normal_impulse, constraint_friction_impulse, nncg_impulse, nncg_direction,
                    solver_velocity, i);
}

#endif
