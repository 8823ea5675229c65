/* overflow.h - the passes of solve.h over the joints past the last colour, in order by one item.
 *
 * A body that has more joints than there are colours has these. The result has the same bits everywhere, but the time
 * grows with their number.
 */
#ifndef TANDEM_SHARED_JOINTS_OVERFLOW_H
#define TANDEM_SHARED_JOINTS_OVERFLOW_H

#include "shared/counts.h"
#include "shared/joints/solve.h"

#define FOR_EACH_OVERFLOW_JOINT(i) \
  for (uint i = counts[JOINT_COLOR_START + COLOR_OVERFLOW]; i < counts[LINK_JOINT_COLOR_START]; ++i)

SHARED void warm_start_overflow_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                            read_turning_bodies bodies, read_joint_axes axes,
                                            read_joint_impulses impulses, GLOBAL const uint *counts,
                                            GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_JOINT(i)
  warm_start_joints_item(parameters, joints, bodies, axes, impulses, solver_velocity, i);
}

SHARED void solve_overflow_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                       read_turning_bodies bodies, read_joint_axes axes, GLOBAL const uint *counts,
                                       write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                       GLOBAL float4 *warm_start_impulse, uint pass, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_JOINT(i)
  solve_joints_item(parameters, joints, bodies, axes, impulses, solver_velocity, warm_start_impulse, pass, i);
}

#endif
