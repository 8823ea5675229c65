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

/* A joint with its factor: what walks read of it. That of a ball, which is long and which few trees have, is read where
 * it is needed. */
typedef struct {
  placed_joint joint;
  single_factor single; /* of a joint with one degree of freedom */
} factored_joint;

SHARED factored_joint load_factored_joint(const articulation *t, tree_link l)
{
  factored_joint f = {load_placed_joint(t, l), load_single_factor(t, l)};
  return f;
}

/* How fast the joint moves by what it takes of an impulse, were its parent held: numbers of its velocity for one degree
 * of freedom (x alone), a vector of the world for a ball. */
typedef struct {
  vec3 pending;
  spatial_force rest; /* for the parent, at its centre */
} joint_share;

SHARED joint_share share_of_single(tree_link l, const factored_joint *f, spatial_force at_b, real push)
{
  real y = (push + power_of(at_b, axis_motion(l, f->joint))) * f->single.inverse;
  joint_share s = {make_vec3(y, R(0.0), R(0.0)), subtract_forces(at_b, scaled_force(f->single.u, y))};
  return s;
}
SHARED joint_share share_of_ball(const ball_factor *f, placed_joint j, spatial_force at_b, vec3 push)
{
  vec3 turns = add(push, at_b.moment);
  joint_share s;
  s.pending = symmetric_times(f->inverse, turns);
  s.rest.moment = subtract(scale(s.pending, j.implicit_inertia), push);
  s.rest.force = subtract(at_b.force, transposed_times(f->g, turns));
  return s;
}

/* at_center: an impulse on the link. push: one of the joint itself, in its numbers, of a ball in axes of the world. */
SHARED joint_share share_of_joint(const articulation *t, tree_link l, const factored_joint *f, spatial_force at_center,
                                  vec3 push)
{
  spatial_force at_b = force_at(at_center, negate(f->joint.to_center));
  joint_share s = {zero3(), at_b};
  mask one = has_one_freedom(l), ball = l.is_ball;
  if (any_of(one)) {
    joint_share single = share_of_single(l, f, at_b, push.x);
    s.pending = choose3(one, single.pending, s.pending);
    s.rest = choose_force(one, single.rest, s.rest);
  }
  if (any_of(ball)) {
    ball_factor factor = load_ball_factor(t, l);
    joint_share of_ball = share_of_ball(&factor, f->joint, at_b, push);
    s.pending = choose3(ball, of_ball.pending, s.pending);
    s.rest = choose_force(ball, of_ball.rest, s.rest);
  }
  s.rest = force_at(s.rest, negate(f->joint.from_parent));
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
SHARED vec3 joint_change(const articulation *t, tree_link l, const factored_joint *f, spatial_motion at_b, vec3 pending)
{
  vec3 change = zero3();
  mask one = has_one_freedom(l), ball = l.is_ball;
  if (any_of(one))
    change = choose3(one, make_vec3(pending.x + change_of_single(&f->single, at_b), R(0.0), R(0.0)), change);
  if (any_of(ball)) {
    ball_factor factor = load_ball_factor(t, l);
    change = choose3(ball, add(pending, change_of_ball(&factor, f->joint, at_b)), change);
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
SHARED spatial_motion free_root_change(const articulation *t, tree_link l, spatial_force pending)
{
  symmetric6 inverse = load_symmetric6(t, l.k);
  return inverse_times(&inverse, pending);
}

/* The change of a link, and of its joint as pending has it. */
typedef struct {
  spatial_motion link;
  vec3 joint;
} pending_motion;

/* parent: its change. */
SHARED pending_motion link_change(const articulation *t, tree_link l, const factored_joint *f, spatial_force pending,
                                  spatial_motion parent)
{
  pending_motion m;
  spatial_motion at_b = motion_at(parent, f->joint.from_parent);
  m.joint = joint_change(t, l, f, at_b, pending.moment);
  vec3 world = choose3(has_one_freedom(l), scale(xyz(f->joint.frame), m.joint.x), m.joint);
  spatial_motion own = joint_motion(l, world, zero3());
  m.link = motion_at(add_motions(at_b, own), f->joint.to_center);
  if (any_of(l.is_free)) m.link = choose_motion(l.is_free, free_root_change(t, l, pending), m.link);
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
    factored_joint f = load_factored_joint(t, l);
    joint_share s = share_of_joint(t, l, &f, at_center, zero3());
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
    factored_joint f = load_factored_joint(t, l);
    m = choose_motion(wanted, link_change(t, l, &f, load_pending(t, l.k), m).link, m);
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
/* What settling a joint gives: the change of its link, and the numbers of its velocity. */
typedef struct {
  spatial_motion change;
  vec3 numbers;
} settled_joint;

/* What settling reads of a link. numbers: of its joint's velocity. */
typedef struct {
  factored_joint joint;
  spatial_force pending;
  vec4 numbers;
} settling_joint;

SHARED void load_settling_joint(const articulation *t, tree_link l, settling_joint *s)
{
  s->joint = load_factored_joint(t, l);
  s->pending = load_pending(t, l.k);
  s->numbers = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY);
}

/* What is pending becomes velocities of the joint. parent: its change. */
SHARED settled_joint settle_joint(const articulation *t, tree_link l, const settling_joint *of, spatial_motion parent)
{
  pending_motion m = link_change(t, l, &of->joint, of->pending, parent);
  vec3 change = m.joint;
  if (any_of(l.is_ball)) change = choose3(l.is_ball, numbers_of_vector(l, of->joint.joint.frame, change), change);
  change = choose3(l.is_free, m.link.angular, change);
  settled_joint s = {m.link, add(xyz(of->numbers), change)};
  store_motion(l.exists, t, l.k, (uint)WORK_CHANGE, s.change);
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_VELOCITY, extend(s.numbers, of->numbers.w));
  if (!any_of(l.is_free)) return s;
  vec4 linear = load_root(t, (uint)ROOT_LINEAR_VELOCITY);
  store_root(l.exists & l.is_free, t, (uint)ROOT_LINEAR_VELOCITY, extend(add(xyz(linear), s.change.linear), linear.w));
  return s;
}

/* And what is the link's. */
typedef struct {
  settling_joint joint;
  spatial_motion velocity;
} settling_link;

SHARED void load_settling_link(const articulation *t, tree_link l, settling_link *s)
{
  load_settling_joint(t, l, &s->joint);
  s->velocity = load_motion(t, l.k, (uint)WORK_VELOCITY);
}

/* What a walk that settles a tree knows of a link. */
typedef struct {
  spatial_motion change, velocity;
} settled_link;

SHARED settled_link resting_ground(void)
{
  settled_link g = {no_motion(), no_motion()};
  return g;
}

/* Link k, of which then nothing is pending. before: link k - 1. */
SHARED settled_link settle_link(const articulation *t, tree_link l, uint k, const settling_link *of,
                                const settled_link *before)
{
  spatial_motion parent = motion_of_parent(t, l, k, before->change, (uint)WORK_CHANGE);
  spatial_motion change = settle_joint(t, l, &of->joint, parent).change;
  settled_link s = {change, add_motions(of->velocity, change)};
  store_motion(l.exists, t, l.k, (uint)WORK_VELOCITY, s.velocity);
  store_force(l.exists, t, l.k, (uint)WORK_PENDING, no_force());
  return s;
}

CALLED void settle_tree_if(mask wanted, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  settled_link s = resting_ground();
  BEGIN_WALK(settling_link, load_settling_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(settling_link, load_settling_link, t, k, k + 1u);
    l.exists = l.exists & wanted;
    s = settle_link(t, l, k, &now, &s);
  }
}
SHARED void settle_tree(const articulation *t) { settle_tree_if(has_links(t), t); }

/* What a link passes on to link k - 1, if that is its parent. */
typedef struct {
  mask follows;
  spatial_force rest;
} passed_force;

SHARED passed_force nothing_passed(const articulation *t)
{
  passed_force p = {has_links(t) & !has_links(t), no_force()};
  return p;
}

/* What it reads of a link. */
typedef struct {
  factored_joint joint;
  spatial_force at_center, pending;
} pushed_link;

SHARED void load_pushed_link(const articulation *t, tree_link l, pushed_link *p)
{
  p->joint = load_factored_joint(t, l);
  p->at_center = load_force(t, l.k, (uint)WORK_FORCE);
  p->pending = no_force();
}
SHARED void load_pushed_link_and_joint(const articulation *t, tree_link l, pushed_link *p)
{
  load_pushed_link(t, l, p);
  p->pending = load_pending(t, l.k);
}

/* beyond: of link k + 1; what others pass on is in WORK_FORCE. */
SHARED passed_force pass_force_inward(const articulation *t, tree_link l, uint k, const pushed_link *of,
                                      const passed_force *beyond)
{
  spatial_force at_center = choose_force(beyond->follows, add_forces(of->at_center, beyond->rest), of->at_center);
  joint_share s = share_of_joint(t, l, &of->joint, at_center, of->pending.moment);
  store_force(l.exists, t, l.k, (uint)WORK_PENDING, pending_share(l, s, at_center));
  mask inner = l.exists & !l.is_root;
  passed_force passed = {inner & follows_at_once(l, k), s.rest};
  mask apart = inner & !passed.follows;
  if (any_of(apart)) add_to_force(apart, t, l.parent, (uint)WORK_FORCE, s.rest);
  return passed;
}

/* Takes the impulses on all links, WORK_FORCE, and those of all joints, WORK_PENDING (of a ball in axes of the world,
 * of a free root none), to what is pending. The settled tree has then the velocities after these impulses. */
CALLED void push_links_and_joints(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  passed_force passed = nothing_passed(t);
  BEGIN_WALK(pushed_link, load_pushed_link_and_joint, t, t->most_links - 1u);
  for (uint n = t->most_links; n > 0u; --n) {
    WALK_TO(pushed_link, load_pushed_link_and_joint, t, n - 1u, n - 2u);
    passed = pass_force_inward(t, l, n - 1u, &now, &passed);
  }
}
/* The same where no joint is pushed, whatever WORK_PENDING has. */
CALLED void push_links(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  passed_force passed = nothing_passed(t);
  BEGIN_WALK(pushed_link, load_pushed_link, t, t->most_links - 1u);
  for (uint n = t->most_links; n > 0u; --n) {
    WALK_TO(pushed_link, load_pushed_link, t, n - 1u, n - 2u);
    passed = pass_force_inward(t, l, n - 1u, &now, &passed);
  }
}

#endif
