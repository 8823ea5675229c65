/* by_world.h - joints of a batch of worlds, where it matters which world a joint belongs to.
 *
 * Overflow joints are solved in order, but those of two worlds share no body. They stand world after world, and the
 * item of the first one of a world solves all of that world. A world with overflow constraints takes further passes
 * over its colours (batching/world_order.h), which must pass over the joints of the other worlds.
 */
#ifndef TANDEM_SHARED_JOINTS_BY_WORLD_H
#define TANDEM_SHARED_JOINTS_BY_WORLD_H

#include "shared/counts.h"
#include "shared/joints/solve.h"

/* By the first body of it. */
SHARED uint world_of_joint(read_joints joints, GLOBAL const uint *body_world, uint i)
{
  uint body = joints.a[i] == INDEX_NONE ? joints.b[i] : joints.a[i];
  return body_world[2u * body];
}

SHARED uint begins_world(read_joints joints, GLOBAL const uint *body_world, GLOBAL const uint *counts, uint i)
{
  uint first = counts[JOINT_COLOR_START + COLOR_OVERFLOW];
  return i == first || world_of_joint(joints, body_world, i) != world_of_joint(joints, body_world, i - 1u) ? 1u : 0u;
}

/* The overflow joints of the world `own`, of which i is the first. */
#define FOR_EACH_OVERFLOW_JOINT_OF_WORLD(k, i, own, body_world) \
  for (uint k = i; k < counts[LINK_JOINT_COLOR_START] && world_of_joint(joints, body_world, k) == (own); ++k)

SHARED void warm_start_overflow_joints_by_world_item(GLOBAL const Parameters *parameters, read_joints joints,
                                                     read_turning_bodies bodies, read_joint_axes axes,
                                                     read_joint_impulses impulses, GLOBAL const uint *body_world,
                                                     GLOBAL const uint *counts, GLOBAL float4 *solver_velocity, uint i)
{
  if (!begins_world(joints, body_world, counts, i)) return;
  uint own = world_of_joint(joints, body_world, i);
  FOR_EACH_OVERFLOW_JOINT_OF_WORLD(k, i, own, body_world)
  warm_start_joints_item(parameters, joints, bodies, axes, impulses, solver_velocity, k);
}

/* further: whether the pass is one of those that only worlds with overflow constraints take. */
SHARED void solve_overflow_joints_by_world_item(GLOBAL const Parameters *parameters, read_joints joints,
                                                read_turning_bodies bodies, read_joint_axes axes,
                                                read_joint_worlds worlds, GLOBAL const uint *counts,
                                                write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                                GLOBAL float4 *warm_start_impulse, uint pass, uint further, uint i)
{
  if (!begins_world(joints, worlds.of_body, counts, i)) return;
  uint own = world_of_joint(joints, worlds.of_body, i);
  if (further && !worlds.overflows[own]) return;
  FOR_EACH_OVERFLOW_JOINT_OF_WORLD(k, i, own, worlds.of_body)
  solve_joints_item(parameters, joints, bodies, axes, impulses, solver_velocity, warm_start_impulse, pass, k);
}

SHARED void solve_joints_further_item(GLOBAL const Parameters *parameters, read_joints joints,
                                      read_turning_bodies bodies, read_joint_axes axes, read_joint_worlds worlds,
                                      write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                      GLOBAL float4 *warm_start_impulse, uint pass, uint i)
{
  if (!worlds.overflows[world_of_joint(joints, worlds.of_body, i)]) return;
  solve_joints_item(parameters, joints, bodies, axes, impulses, solver_velocity, warm_start_impulse, pass, i);
}

SHARED void reset_joints_item(GLOBAL const Parameters *parameters, GLOBAL const uint *reset_joint,
                              write_cached_joint_impulses cached, uint i)
{
  uint joint = reset_joint[i];
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(cached.linear, joint, zero);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) store_float4(cached.angular, joint, zero);
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k) store_float4(cached.axis, joint_plane(parameters, k) + joint, zero);
}

#endif
