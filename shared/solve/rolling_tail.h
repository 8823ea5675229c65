/* rolling_tail.h - rolling.h for constraints without a colour of their own, in order; see shared/solve/tail.h. */
#ifndef TANDEM_SHARED_SOLVE_ROLLING_TAIL_H
#define TANDEM_SHARED_SOLVE_ROLLING_TAIL_H

#include "shared/solve/rolling.h"
#include "shared/solve/tail.h"

SHARED void warm_start_rolling_tail_item(read_contacts contacts, GLOBAL const row *constraint_rolling,
                                         GLOBAL const row *solver_inertia, GLOBAL const uint *counts,
                                         GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  warm_start_rolling_item(contacts, constraint_rolling, solver_inertia, counts, solver_velocity, i);
}

SHARED void solve_rolling_tail_item(read_contacts contacts, GLOBAL const row *constraint_normal_impulse,
                                    GLOBAL const row *solver_inertia, GLOBAL const uint *counts,
                                    GLOBAL row *constraint_rolling, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  solve_rolling_item(contacts, constraint_normal_impulse, solver_inertia, counts, constraint_rolling, solver_velocity,
                     i);
}

#endif
