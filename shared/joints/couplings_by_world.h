/* couplings_by_world.h - couplings of a batch of worlds, where it matters which world a coupling belongs to; see
 * by_world.h, which says when. Bodies of a batch do not sleep. */
#ifndef TANDEM_SHARED_JOINTS_COUPLINGS_BY_WORLD_H
#define TANDEM_SHARED_JOINTS_COUPLINGS_BY_WORLD_H

#include "shared/joints/by_world.h"
#include "shared/joints/couplings.h"

SHARED uint world_of_coupling(read_couplings couplings, read_joints joints, GLOBAL const uint *body_world, uint i)
{
  return world_of_joint(joints, body_world, couplings.a[i]);
}

/* further: whether the pass is one of those that only worlds with overflow constraints take. */
SHARED void solve_overflow_couplings_by_world_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                                   read_joints joints, read_turning_bodies bodies,
                                                   read_joint_worlds worlds, GLOBAL const uint *counts,
                                                   GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity,
                                                   GLOBAL float4 *warm_start_impulse, uint pass, uint further, uint i)
{
  uint own = world_of_coupling(couplings, joints, worlds.of_body, i);
  if (i > counts[COUPLING_COLOR_START + COLOR_OVERFLOW] &&
      own == world_of_coupling(couplings, joints, worlds.of_body, i - 1u))
    return; /* the item of the first one of a world solves all of that world */
  if (further && !worlds.overflows[own]) return;
  for (uint k = i; k < counts[COUNT_COUPLINGS] && world_of_coupling(couplings, joints, worlds.of_body, k) == own; ++k)
    solve_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, warm_start_impulse, pass, k);
}

SHARED void solve_couplings_further_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                         read_joints joints, read_turning_bodies bodies, read_joint_worlds worlds,
                                         GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity,
                                         GLOBAL float4 *warm_start_impulse, uint pass, uint i)
{
  if (!worlds.overflows[world_of_coupling(couplings, joints, worlds.of_body, i)]) return;
  solve_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, warm_start_impulse, pass, i);
}

SHARED void reset_couplings_item(GLOBAL const uint *reset_coupling, GLOBAL memory_real *cached, uint i)
{
  store_real(cached, reset_coupling[i], R(0.0));
}

#endif
