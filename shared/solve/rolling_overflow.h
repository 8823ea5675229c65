/* rolling_overflow.h - the passes of rolling.h over the constraints past the last colour, in order by one item; see
 * shared/solve/overflow.h. */
#ifndef TANDEM_SHARED_SOLVE_ROLLING_OVERFLOW_H
#define TANDEM_SHARED_SOLVE_ROLLING_OVERFLOW_H

#include "shared/solve/overflow.h"
#include "shared/solve/rolling.h"

SHARED void warm_start_rolling_overflow_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                             GLOBAL const float4 *constraint_rolling,
                                             GLOBAL const float4 *solver_inertia, GLOBAL const uint *counts,
                                             GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_CONSTRAINT(i)
  warm_start_rolling_item(parameters, contacts, constraint_rolling, solver_inertia, counts, solver_velocity, i);
}

SHARED void solve_rolling_overflow_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                        GLOBAL const float4 *constraint_normal_impulse,
                                        GLOBAL const float4 *solver_inertia, GLOBAL const uint *counts,
                                        GLOBAL float4 *constraint_rolling, GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_CONSTRAINT(i)
  solve_rolling_item(parameters, contacts, constraint_normal_impulse, solver_inertia, counts, constraint_rolling,
                     solver_velocity, i);
}

#endif
