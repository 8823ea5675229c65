/* couplings_by_world.h - couplings of a batch of worlds, where it matters which world a coupling belongs to; see
 * by_world.h, which says when. Bodies of a batch do not sleep. */
#ifndef TANDEM_SHARED_JOINTS_COUPLINGS_BY_WORLD_H
#define TANDEM_SHARED_JOINTS_COUPLINGS_BY_WORLD_H

#include "shared/joints/by_world.h"
#include "shared/joints/couplings.h"

/* A coupling one of whose joints is not enabled does nothing, and has no place that says its world. */
SHARED uint acts_in_world(read_couplings couplings, uint i)
{
  return couplings.a[i] != INDEX_NONE && couplings.b[i] != INDEX_NONE ? 1u : 0u;
}

SHARED uint world_of_coupling(read_couplings couplings, read_joints joints, GLOBAL const uint *body_world, uint i)
{
  return world_of_joint(joints, body_world, couplings.a[i]);
}

/* Whether coupling i is the first of its world among those past the last colour. */
SHARED uint begins_world_of_couplings(read_couplings couplings, read_joints joints, GLOBAL const uint *body_world,
                                      GLOBAL const uint *counts, uint i)
{
  if (!acts_in_world(couplings, i)) return 0u;
  uint before = i, first = counts[COUPLING_COLOR_START + COLOR_OVERFLOW];
  while (before > first && !acts_in_world(couplings, before - 1u)) --before;
  return before == first || world_of_coupling(couplings, joints, body_world, before - 1u) !=
                                world_of_coupling(couplings, joints, body_world, i)
             ? 1u
             : 0u;
}

/* further: whether the pass is one of those that only worlds with overflow constraints take. The item of the first
 * coupling of a world solves all of that world. */
SHARED void solve_overflow_couplings_by_world_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                                   read_joints joints, read_turning_bodies bodies,
                                                   read_joint_worlds worlds, GLOBAL const uint *counts,
                                                   GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity,
                                                   GLOBAL float4 *warm_start_impulse, uint pass, uint further, uint i)
{
  if (!begins_world_of_couplings(couplings, joints, worlds.of_body, counts, i)) return;
  uint own = world_of_coupling(couplings, joints, worlds.of_body, i);
  if (further && !worlds.overflows[own]) return;
  for (uint k = i; k < counts[COUNT_COUPLINGS]; ++k) {
    if (!acts_in_world(couplings, k)) continue;
    if (world_of_coupling(couplings, joints, worlds.of_body, k) != own) return;
    solve_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, warm_start_impulse, pass, k);
  }
}

SHARED void solve_couplings_further_item(GLOBAL const Parameters *parameters, read_couplings couplings,
                                         read_joints joints, read_turning_bodies bodies, read_joint_worlds worlds,
                                         GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity,
                                         GLOBAL float4 *warm_start_impulse, uint pass, uint i)
{
  if (!acts_in_world(couplings, i)) return;
  if (!worlds.overflows[world_of_coupling(couplings, joints, worlds.of_body, i)]) return;
  solve_couplings_item(parameters, couplings, joints, bodies, impulse, solver_velocity, warm_start_impulse, pass, i);
}

SHARED void reset_couplings_item(GLOBAL const uint *reset_coupling, GLOBAL memory_real *cached, uint i)
{
  store_real(cached, reset_coupling[i], R(0.0));
}

#endif
