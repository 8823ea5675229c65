/* respond.h - how a factored tree (factor.h) answers to impulses.
 *
 *     impulse on a link           inward    what each joint takes of it is pending there; the rest goes to the parent
 *     change of a link's velocity outward   from the root to the link, out of what is pending on the way
 *     settle_tree                           the pending changes become velocities, and nothing is pending
 *
 * An impulse on one link and the change of velocity of one link cost a walk between it and the root each, however many
 * links the tree has, and both are exact: changes are linear in the impulses, so what is pending adds up. All joint
 * velocities are brought up to date once by settle_tree. The same walks over all links solve the equations of motion.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_RESPOND_H
#define TANDEM_SHARED_ARTICULATIONS_RESPOND_H

#include "shared/articulations/factor.h"

/* How fast the joint moves by what it takes of an impulse, were its parent held: numbers of its velocity for one degree
 * of freedom (x alone), a vector of the world for a ball. */
typedef struct {
  vec3 pending;
  spatial_force rest; /* for the parent, at its centre */
} joint_share;

SHARED joint_share share_of_single(const articulation *t, tree_link l, placed_joint j, spatial_force at_b, real push)
{
  single_factor f = load_single_factor(t, l);
  real y = (push + power_of(at_b, axis_motion(l, j))) * f.inverse;
  joint_share s = {make_vec3(y, R(0.0), R(0.0)), subtract_forces(at_b, scaled_force(f.u, y))};
  return s;
}
SHARED joint_share share_of_ball(const articulation *t, tree_link l, placed_joint j, spatial_force at_b, vec3 push)
{
  ball_factor f = load_ball_factor(t, l);
  vec3 turns = add(push, at_b.moment);
  joint_share s;
  s.pending = symmetric_times(f.inverse, turns);
  s.rest.moment = subtract(scale(s.pending, j.implicit_inertia), push);
  s.rest.force = subtract(at_b.force, transposed_times(f.g, turns));
  return s;
}

/* at_center: an impulse on the link. push: one of the joint itself, in its numbers, of a ball in axes of the world. */
SHARED joint_share share_of_joint(const articulation *t, tree_link l, placed_joint j, spatial_force at_center,
                                  vec3 push)
{
  spatial_force at_b = force_at(at_center, negate(j.to_center));
  joint_share s = {zero3(), at_b};
  mask one = has_one_freedom(l);
  if (any_of(one)) {
    joint_share single = share_of_single(t, l, j, at_b, push.x);
    s.pending = choose3(one, single.pending, s.pending);
    s.rest = choose_force(one, single.rest, s.rest);
  }
  if (any_of(l.is_ball)) {
    joint_share ball = share_of_ball(t, l, j, at_b, push);
    s.pending = choose3(l.is_ball, ball.pending, s.pending);
    s.rest = choose_force(l.is_ball, ball.rest, s.rest);
  }
  s.rest = force_at(s.rest, negate(j.from_parent));
  return s;
}

/* The velocity that a joint gets while its parent changes as at_b says, at frame b, and nothing pushes the joint;
 * numbers as pending has them. */
SHARED real change_of_single(const single_factor *f, spatial_motion at_b)
{
  return -(power_of(f->u, at_b) * f->inverse);
}
SHARED vec3 change_of_ball(const ball_factor *f, placed_joint j, spatial_motion at_b)
{
  vec3 held = scale(symmetric_times(f->inverse, at_b.angular), j.implicit_inertia);
  return negate(subtract(at_b.angular, subtract(held, matrix_times(f->g, at_b.linear))));
}

/* The same of a joint that has been pushed. */
SHARED vec3 joint_change(const articulation *t, tree_link l, placed_joint j, spatial_motion at_b, vec3 pending)
{
  vec3 change = zero3();
  mask one = has_one_freedom(l);
  if (any_of(one)) {
    single_factor f = load_single_factor(t, l);
    change = choose3(one, make_vec3(pending.x + change_of_single(&f, at_b), R(0.0), R(0.0)), change);
  }
  if (any_of(l.is_ball)) {
    ball_factor f = load_ball_factor(t, l);
    change = choose3(l.is_ball, add(pending, change_of_ball(&f, j, at_b)), change);
  }
  return change;
}

/* What of an impulse on a link is pending there: its joint's share; of a free root all of it. */
SHARED spatial_force pending_share(tree_link l, joint_share s, spatial_force at_center)
{
  spatial_force of_joint = {s.pending, zero3()};
  return choose_force(l.is_free, at_center, of_joint);
}

SHARED spatial_force load_pending(const articulation *t, shape_uint k) { return load_force(t, k, (uint)WORK_PENDING); }

/* The change of a free root, all of whose impulses are pending. */
SHARED spatial_motion free_root_change(const articulation *t, tree_link l)
{
  symmetric6 inverse = load_symmetric6(t, l.k);
  return inverse_times(&inverse, load_pending(t, l.k));
}

/* parent: its change. *change: of the joint, as pending has it. */
SHARED spatial_motion link_change(const articulation *t, tree_link l, spatial_motion parent, vec3 *change)
{
  placed_joint j = load_placed_joint(t, l);
  spatial_motion at_b = motion_at(parent, j.from_parent);
  *change = joint_change(t, l, j, at_b, load_pending(t, l.k).moment);
  vec3 world = choose3(has_one_freedom(l), scale(xyz(j.frame), change->x), *change);
  spatial_motion own = joint_motion(l, world, zero3());
  spatial_motion m = {add(at_b.angular, own.angular), add(at_b.linear, own.linear)};
  m = motion_at(m, j.to_center);
  if (any_of(l.is_free)) m = choose_motion(l.is_free, free_root_change(t, l), m);
  return m;
}

/* --- one link ------------------------------------------------------------------------------------------------- */
/* The joints towards the root take their shares; a joint whose parent is the ground keeps the rest from it. */
CALLED void push_link_if(mask wanted, const articulation *tree, uint_lanes k, const spatial_force *impulse)
{
  articulation own = *tree;
  const articulation *t = &own;
  spatial_force at_center = *impulse;
  while (any_of(wanted)) {
    tree_link l = tree_link_of(t, k);
    joint_share s = share_of_joint(t, l, load_placed_joint(t, l), at_center, zero3());
    add_to_force(wanted, t, k, (uint)WORK_PENDING, pending_share(l, s, at_center));
    wanted = wanted & !l.is_root;
    k = choose(wanted, l.parent, k);
    at_center = choose_force(wanted, s.rest, at_center);
  }
}
/* An impulse on link k, at its centre. */
SHARED void push_link(const articulation *t, uint_lanes k, spatial_force impulse)
{
  push_link_if(k < t->links, t, k, &impulse);
}

/* Notes at each link between k and the root the next one on the way to k. */
SHARED void note_path(mask wanted, const articulation *t, uint_lanes k)
{
  store_uint_of_row_if(wanted, t->next, tree_row(t, 1u, k, 0u), k);
  while (any_of(wanted)) {
    tree_link l = tree_link_of(t, k);
    wanted = wanted & !l.is_root;
    store_uint_of_row_if(wanted, t->next, tree_row(t, 1u, l.parent, 0u), k);
    k = choose(wanted, l.parent, k);
  }
}

CALLED void find_pending_change(const articulation *tree, uint_lanes k, spatial_motion *change)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask wanted = k < t->links;
  note_path(wanted, t, k);
  uint_lanes at = choose(wanted, (uint_lanes)0u, k);
  spatial_motion m = no_motion();
  while (any_of(wanted)) {
    tree_link l = tree_link_of(t, at);
    vec3 of_joint;
    m = choose_motion(wanted, link_change(t, l, m, &of_joint), m);
    uint_lanes following = load_uint_of_row(t->next, tree_row(t, 1u, l.k, 0u));
    wanted = wanted & (following != at);
    at = choose(wanted, following, at);
  }
  *change = m;
}
/* The change of velocity of link k since the tree was settled, at its centre. */
SHARED spatial_motion pending_change(const articulation *t, uint_lanes k)
{
  spatial_motion m;
  find_pending_change(t, k, &m);
  return m;
}

/* --- all links ------------------------------------------------------------------------------------------------ */
/* The pending numbers of the joint's velocity. */
SHARED vec3 change_in_numbers(tree_link l, placed_joint j, vec3 change)
{
  return choose3(l.is_ball, numbers_of_vector(l, j.frame, change), change);
}

SHARED void settle_link(const articulation *t, tree_link l)
{
  vec3 change;
  spatial_motion m = link_change(t, l, load_parent_motion(t, l, (uint)WORK_CHANGE), &change);
  store_motion(l.exists, t, l.k, (uint)WORK_CHANGE, m);
  change = choose3(l.is_free, m.angular, change_in_numbers(l, load_placed_joint(t, l), change));
  vec4 velocity = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY);
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_VELOCITY, extend(add(xyz(velocity), change), velocity.w));
  spatial_motion old = load_motion(t, l.k, (uint)WORK_VELOCITY);
  spatial_motion now = {add(old.angular, m.angular), add(old.linear, m.linear)};
  store_motion(l.exists, t, l.k, (uint)WORK_VELOCITY, now);
  store_force(l.exists, t, l.k, (uint)WORK_PENDING, no_force());
  if (!any_of(l.is_free)) return;
  vec4 linear = load_root(t, (uint)ROOT_LINEAR_VELOCITY);
  store_root(l.exists & l.is_free, t, (uint)ROOT_LINEAR_VELOCITY, extend(add(xyz(linear), m.linear), linear.w));
}

CALLED void settle_tree_if(mask wanted, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    l.exists = l.exists & wanted;
    settle_link(t, l);
  }
}
SHARED void settle_tree(const articulation *t) { settle_tree_if(has_links(t), t); }

/* Takes the impulses on all links, WORK_FORCE, and those of all joints, WORK_PENDING (of a ball in axes of the world,
 * of a free root none), to what is pending. The settled tree has then the velocities after these impulses. */
CALLED void push_all_links(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint n = t->most_links; n > 0u; --n) {
    tree_link l = tree_link_of(t, n - 1u);
    spatial_force at_center = load_force(t, l.k, (uint)WORK_FORCE);
    joint_share s = share_of_joint(t, l, load_placed_joint(t, l), at_center, load_pending(t, l.k).moment);
    store_force(l.exists, t, l.k, (uint)WORK_PENDING, pending_share(l, s, at_center));
    add_to_force(l.exists & !l.is_root, t, l.parent, (uint)WORK_FORCE, s.rest);
  }
}

#endif
