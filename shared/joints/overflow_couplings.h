/* overflow_couplings.h - the passes of couplings.h over the couplings past the last colour, in order by one item, as
 * overflow.h has those of joints. */
#ifndef TANDEM_SHARED_JOINTS_OVERFLOW_COUPLINGS_H
#define TANDEM_SHARED_JOINTS_OVERFLOW_COUPLINGS_H

#include "shared/counts.h"
#include "shared/joints/couplings.h"

#define FOR_EACH_OVERFLOW_COUPLING(i) \
  for (uint i = counts[COUPLING_COLOR_START + COLOR_OVERFLOW]; i < counts[COUNT_COUPLINGS]; ++i)

SHARED void warm_start_overflow_couplings_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                               read_joints joints, read_turning_bodies bodies,
                                               GLOBAL const memory_real *impulse, GLOBAL const uint *counts,
                                               GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_COUPLING(i)
  warm_start_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, i);
}

SHARED void solve_overflow_couplings_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                          read_joints joints, read_turning_bodies bodies, GLOBAL const uint *counts,
                                          GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity,
                                          GLOBAL float4 *warm_start_impulse, uint pass, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_COUPLING(i)
  solve_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, warm_start_impulse, pass, i);
}

#endif
