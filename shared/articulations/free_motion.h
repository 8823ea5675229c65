/* free_motion.h - moves a tree over a substep that nothing pushes: only its own momentum carries it.
 *
 *     at q    half of the inertial forces, at the velocity that they lead to     v -> u
 *             the joints move with u                                              q -> q'
 *     at q'   the other half, at the velocity u                                   u -> v'
 *
 * The second half is the first one backward in time, so the errors of both halves in energy cancel: they grow with
 * neither turns nor time, as those of symmetric rules do (Hairer, Lubich and Wanner, "Geometric Numerical Integration",
 * 2006). The first half defines u by itself and is iterated; each of its rounds reduces the error by the angle of a
 * turn in half a substep.
 *
 * Trees that turn too fast for the rounds to converge skip the first half. The centre of mass of a free tree moves
 * straight; last, momentum and energy become what they were (conserved.h), so no speed makes a tree fly apart.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_FREE_MOTION_H
#define TANDEM_SHARED_ARTICULATIONS_FREE_MOTION_H

#include "shared/articulations/conserved.h"
#include "shared/articulations/link_inertia.h"

#define FREE_MOTION_ROUNDS 2u

/* The numbers by which joints move in h: STATE_JOINT_POSITION and the position of a free root. */
SHARED void advance_joint(const articulation *t, tree_link l, real h)
{
  vec4 position = load_state(t, l.k, (uint)STATE_JOINT_POSITION);
  vec3 way = scale(xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY)), h);
  vec4 next =
      make_vec4(position.x + choose(has_one_freedom(l), way.x, (real)R(0.0)), position.y, position.z, position.w);
  mask turns = l.is_ball | l.is_free;
  if (any_of(turns)) next = choose4(turns, quat_to_vec4(turned(quat_from(position), way)), next);
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_POSITION, next);
  if (!any_of(l.is_free)) return;
  double_float3 at = moved_position(root_position(t), scale(xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)), h));
  mask moves = l.exists & l.is_free;
  store_root(moves, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(moves, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
}

/* The velocity with which a substep starts; links keep theirs when that of their joint returns to it. */
SHARED void note_velocity(const articulation *t, tree_link l)
{
  store_work(l.exists, t, l.k, (uint)WORK_START, load_state(t, l.k, (uint)STATE_JOINT_VELOCITY));
}
SHARED void return_velocity_if(mask wanted, const articulation *t, tree_link l)
{
  store_state(wanted & l.exists, t, l.k, (uint)STATE_JOINT_VELOCITY, load_work(t, l.k, (uint)WORK_START));
}
CALLED void return_velocities_if(mask wanted, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) return_velocity_if(wanted, t, tree_link_of(t, k));
  store_root(wanted, t, (uint)ROOT_LINEAR_VELOCITY, load_root(t, (uint)ROOT_START));
}

/* The inertial forces at the velocities that the last round has found, which then return to those of the start. */
CALLED void load_inertial_forces_of_round(const articulation *tree, real h, uint round)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    load_inertial_force(t, l, h);
    if (round == 0u) note_velocity(t, l);
    else return_velocity_if(l.exists, t, l);
  }
  if (round == 0u) store_root(has_links(t), t, (uint)ROOT_START, load_root(t, (uint)ROOT_LINEAR_VELOCITY));
  else store_root(has_links(t), t, (uint)ROOT_LINEAR_VELOCITY, load_root(t, (uint)ROOT_START));
}

CALLED void settle_and_move_links(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    settle_link(t, l);
    move_link(t, l);
  }
}

/* The velocities of all joints and links, after half of the inertial forces at the velocity that this leads to. */
SHARED void first_half(const articulation *t, real h)
{
  for (uint round = 0; round < FREE_MOTION_ROUNDS; ++round) {
    load_inertial_forces_of_round(t, R(0.5) * h, round);
    push_all_links(t);
    settle_and_move_links(t);
  }
}

SHARED void second_half(const articulation *t, real h)
{
  load_inertial_forces(t, R(0.5) * h);
  push_all_links(t);
  settle_tree(t);
}

/* The links where their joints are, after these have moved on if that is wanted. A walk over the links does all that
 * needs no more than the parent, because it takes its time to come to a link rather than to compute there. */
CALLED void place_tree(const articulation *tree, real h, uint advances)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    if (advances != 0u) advance_joint(t, l, h);
    place_link(t, l, h);
    move_link(t, l);
    store_symmetric6(l.exists, t, l.k, inertia_of_link(t, l));
  }
}

/* The links where their joints are, and what they answer to impulses there. */
SHARED void prepare_tree(const articulation *t, real h)
{
  place_tree(t, h, 0u);
  factor_tree(t);
  invert_link_inertias(t);
}

/* The centre of mass of a free tree moves straight, whatever the root does beside it. */
SHARED vec3 way_missed_by_center(const articulation *t, conserved before, vec3 way_of_root, real h)
{
  vec3 moved = add(way_of_root, subtract(center_of_tree(t, before.inverse_mass), before.center));
  return choose3(tree_link_of(t, 0u).is_free, subtract(scale(before.drift, h), moved), zero3());
}
SHARED void move_root_by(const articulation *t, vec3 way)
{
  mask free = tree_link_of(t, 0u).is_free & has_links(t);
  double_float3 at = moved_position(root_position(t), way);
  store_root(free, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(free, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
}

/* The rounds did not converge if half a substep, which should change next to nothing of the energy, changes so much.
 * With 0.02, robots that thrash skipped the first half in many steps of 5 ms, and were twice as far from a run that had
 * converged after 0.2 s; trees that turn by 100 rad/s want less than 0.1. */
#define LARGEST_CHANGE_IN_HALF R(0.05)

SHARED void move_tree_freely(const articulation *t, real h)
{
  conserved kept = conserved_of_tree(t);
  first_half(t, h);
  mask fast = has_changed_energy(t, kept, LARGEST_CHANGE_IN_HALF);
  if (any_of(fast)) return_velocities_if(fast, t);
  vec3 way = scale(root_velocity(t), h); /* of the root; a difference of positions would depend on where the tree is */
  place_tree(t, h, 1u);
  factor_tree(t);
  invert_link_inertias(t);
  vec3 missed = way_missed_by_center(t, kept, way, h);
  move_root_by(t, missed);
  kept.momentum = force_at(kept.momentum, add(way, missed));
  second_half(t, h);
  conserve(t, kept);
}

#endif
