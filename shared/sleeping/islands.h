/* islands.h - islands of bodies that touch each other or are joined, and which of them may fall asleep.
 *
 *     box 4 -- box 2 -- box 7      ground      box 3 -- box 5
 *     label 2  label 2  label 2       -        label 3  label 3
 *
 * The label of an island is the lowest index of its bodies. Contacts and joints join dynamic bodies alone, because
 * whatever stands on one ground would otherwise be one island. Labels come from hooking and pointer jumping (Shiloach
 * and Vishkin, "An O(log n) parallel connectivity algorithm", 1982), in rounds of three kernels:
 *
 *   hook_islands   each contact sets the next label of the higher of its two labels to the lower one, by a minimum;
 *                  hook_joints does so for each joint, hook_couplings for the bodies of joints that are coupled, and
 *                  hook_links for the links of an articulation
 *   jump_islands   each body takes the next label of its next label
 *   follow_labels  the next label of each body is no higher than its label, so that jumps become twice as long
 *
 * Minima of integers do not depend on order, and each kernel reads what another one wrote, so every round has the
 * same bits on every backend. A round that changes nothing is the last; if there was none, the step runs again with
 * more rounds.
 *
 * An island stays awake if one of its bodies is not drowsy, touches a kinematic body that moves or is joined to one, or
 * touches a trigger while one of the two may move.
 */
#ifndef TANDEM_SHARED_SLEEPING_ISLANDS_H
#define TANDEM_SHARED_SLEEPING_ISLANDS_H

#include "shared/batching/nodes.h"
#include "shared/sleeping/rest.h"

SHARED void begin_islands_item(GLOBAL uint *island_label, GLOBAL uint *island_next, GLOBAL uint *island_awake, uint i)
{
  island_label[i] = island_next[i] = i;
  island_awake[i] = 0u;
}

SHARED void hook_bodies(GLOBAL const uint *body_flags, GLOBAL const uint *island_label, GLOBAL uint *island_next,
                        GLOBAL uint *counts, uint round, uint a, uint b)
{
  if (!is_dynamic(body_flags, a) || !is_dynamic(body_flags, b)) return;
  uint one = island_label[a], other = island_label[b];
  if (one == other) return;
  uint lower = one < other ? one : other, higher = one < other ? other : one;
  ATOMIC_MIN(island_next + higher, lower);
  ATOMIC_MAX(counts + COUNT_ISLAND_ROUNDS, round + 1u);
}

SHARED void hook_islands_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                              GLOBAL const uint *body_flags, GLOBAL const uint *island_label, GLOBAL uint *island_next,
                              GLOBAL uint *counts, uint round, uint i)
{
  hook_bodies(body_flags, island_label, island_next, counts, round, constraint_a[i], constraint_b[i]);
}

SHARED uint is_to_world(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, uint i)
{
  return joint_a[i] == INDEX_NONE || joint_b[i] == INDEX_NONE ? 1u : 0u;
}

/* A joint to the world joins nothing. */
SHARED void hook_joints_item(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, GLOBAL const uint *body_flags,
                             GLOBAL const uint *island_label, GLOBAL uint *island_next, GLOBAL uint *counts, uint round,
                             uint i)
{
  if (is_to_world(joint_a, joint_b, i)) return;
  hook_bodies(body_flags, island_label, island_next, counts, round, joint_a[i], joint_b[i]);
}

/* Each joint has a body that is dynamic, and what is coupled is one island by these. */
SHARED void hook_couplings_item(GLOBAL const uint *coupling_a, GLOBAL const uint *coupling_b,
                                GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, GLOBAL const uint *body_flags,
                                GLOBAL const uint *island_label, GLOBAL uint *island_next, GLOBAL uint *counts,
                                uint round, uint i)
{
  uint one = coupling_a[i], other = coupling_b[i];
  if (one == INDEX_NONE || other == INDEX_NONE) return;
  for (uint k = 0; k < 4u; ++k) {
    uint a = (k & 1u) != 0u ? joint_a[one] : joint_b[one], b = (k & 2u) != 0u ? joint_a[other] : joint_b[other];
    if (a != INDEX_NONE && b != INDEX_NONE) hook_bodies(body_flags, island_label, island_next, counts, round, a, b);
  }
}

/* An articulation is one island, whatever holds its root. */
SHARED void hook_links_item(GLOBAL const uint *body_link, GLOBAL const uint *body_flags,
                            GLOBAL const uint *island_label, GLOBAL uint *island_next, GLOBAL uint *counts, uint round,
                            uint i)
{
  if (is_link(body_link, i))
    hook_bodies(body_flags, island_label, island_next, counts, round, i, body_link[LINK_WORDS * i]);
}

/* The next label of a body may be older than its label, and both are labels of its island; the lower one counts. */
SHARED void jump_islands_item(GLOBAL const uint *island_next, GLOBAL uint *island_label, GLOBAL uint *counts,
                              uint round, uint i)
{
  uint label = island_label[i], lowest = island_next[i] < label ? island_next[i] : label, next = island_next[lowest];
  uint jumped = next < lowest ? next : lowest;
  if (jumped == label) return;
  island_label[i] = jumped;
  ATOMIC_MAX(counts + COUNT_ISLAND_ROUNDS, round + 1u);
}

SHARED void follow_labels_item(GLOBAL const uint *island_label, GLOBAL uint *island_next, uint i)
{
  if (island_label[i] < island_next[i]) island_next[i] = island_label[i];
}

/* rounds: the number that the host launched. */
SHARED void finish_islands_item(GLOBAL uint *counts, uint rounds, uint i)
{
  (void)i;
  counts[COUNT_ISLANDS_OPEN] = counts[COUNT_ISLAND_ROUNDS] >= rounds ? 1u : 0u;
}

SHARED void keep_islands_awake_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                    GLOBAL const uint *rest_count, GLOBAL const uint *island_label,
                                    GLOBAL uint *island_awake, uint i)
{
  if (is_dynamic(body_flags, i) && rest_count[i] < parameters->sleep_steps)
    ATOMIC_OR(island_awake + island_label[i], 1u);
}

SHARED uint is_moving_kinematic(GLOBAL const uint *body_flags, GLOBAL const float4 *velocity, uint body)
{
  spatial_velocity m = load_velocity(velocity, body);
  return body_type_of(body_flags[body]) == (uint)BODY_TYPE_KINEMATIC &&
                 (length_squared(m.linear) > R(0.0) || length_squared(m.angular) > R(0.0))
             ? 1u
             : 0u;
}

SHARED void keep_bodies_awake(GLOBAL const uint *body_flags, GLOBAL const float4 *solver_velocity,
                              GLOBAL const uint *island_label, GLOBAL uint *island_awake, uint a, uint b)
{
  if (is_moving_kinematic(body_flags, solver_velocity, a)) ATOMIC_OR(island_awake + island_label[b], 1u);
  if (is_moving_kinematic(body_flags, solver_velocity, b)) ATOMIC_OR(island_awake + island_label[a], 1u);
}

SHARED void keep_carried_awake_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                    GLOBAL const uint *body_flags, GLOBAL const float4 *solver_velocity,
                                    GLOBAL const uint *island_label, GLOBAL uint *island_awake, uint i)
{
  keep_bodies_awake(body_flags, solver_velocity, island_label, island_awake, constraint_a[i], constraint_b[i]);
}

SHARED void keep_joined_awake_item(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b,
                                   GLOBAL const uint *body_flags, GLOBAL const float4 *solver_velocity,
                                   GLOBAL const uint *island_label, GLOBAL uint *island_awake, uint i)
{
  if (is_to_world(joint_a, joint_b, i)) return;
  keep_bodies_awake(body_flags, solver_velocity, island_label, island_awake, joint_a[i], joint_b[i]);
}

SHARED uint may_move(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags, GLOBAL const uint *rest_count,
                     GLOBAL const float4 *velocity, uint body)
{
  if (is_dynamic(body_flags, body)) return rest_count[body] < parameters->sleep_steps ? 1u : 0u;
  return is_moving_kinematic(body_flags, velocity, body);
}

/* A trigger has no constraints. What it touches stays awake while one of the two may move, because the trigger would
 * wake it again and again. */
SHARED void keep_triggers_awake_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a,
                                     GLOBAL const uint *pair_b, GLOBAL const uint *manifold_count,
                                     GLOBAL const uint *body_flags, GLOBAL const uint *rest_count,
                                     GLOBAL const float4 *solver_velocity, GLOBAL const uint *island_label,
                                     GLOBAL uint *island_awake, uint i)
{
  uint a = pair_a[i], b = pair_b[i];
  if (manifold_count[i] == 0u || !is_trigger(body_flags[a] | body_flags[b])) return;
  if (may_move(parameters, body_flags, rest_count, solver_velocity, a)) ATOMIC_OR(island_awake + island_label[b], 1u);
  if (may_move(parameters, body_flags, rest_count, solver_velocity, b)) ATOMIC_OR(island_awake + island_label[a], 1u);
}

SHARED void choose_sleepers_item(GLOBAL const uint *body_flags, GLOBAL const uint *island_label,
                                 GLOBAL const uint *island_awake, GLOBAL uint *falls_asleep, GLOBAL uint *counts,
                                 uint i)
{
  uint falls = is_dynamic(body_flags, i) && !island_awake[island_label[i]] ? 1u : 0u;
  falls_asleep[i] = falls;
  if (falls) ATOMIC_ADD(counts + COUNT_FALLING_ASLEEP, 1u);
}

#endif
