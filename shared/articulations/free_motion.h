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

/* STATE_JOINT_POSITION after h; the centre of a free root moves on, too. */
SHARED vec4 advance_joint(const articulation *t, tree_link l, vec4 position, vec3 numbers, real h)
{
  vec3 way = scale(numbers, h);
  vec4 next =
      make_vec4(position.x + choose(has_one_freedom(l), way.x, (real)R(0.0)), position.y, position.z, position.w);
  mask turns = l.is_ball | l.is_free;
  if (any_of(turns)) next = choose4(turns, quat_to_vec4(turned(quat_from(position), way)), next);
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_POSITION, next);
  if (!any_of(l.is_free)) return next;
  double_float3 at = moved_position(root_position(t), scale(xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)), h));
  mask moves = l.exists & l.is_free;
  store_root(moves, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(moves, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
  return next;
}

/* The velocity with which a substep starts; links keep theirs when that of their joint returns to it. */
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

/* --- the first half ------------------------------------------------------------------------------------------- */
/* A walk over the links does all that needs no more than the parent, because it takes its time to come to a link rather
 * than to compute there. */

/* What the first walk reads of a link. */
typedef struct {
  circling_record moves;
  vec4 start;
  real armature;
} starting_link;

SHARED void load_starting_link(const articulation *t, tree_link l, starting_link *s)
{
  load_circling_record(t, l, &s->moves);
  s->start = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY);
  s->armature = armature_of_link(t, l);
}

/* The forces of the first round; the energy before, as seen from a frame that moves so. */
CALLED void begin_first_half(const articulation *tree, real h, vec3 frame, real *energy)
{
  articulation own = *tree;
  const articulation *t = &own;
  real sum = R(0.0);
  circling_link c = circling_ground();
  BEGIN_WALK(starting_link, load_starting_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(starting_link, load_starting_link, t, k, k + 1u);
    sum = sum + choose(l.exists,
                       energy_of_link(&now.moves.solid, now.moves.velocity, now.moves.numbers, now.armature, frame),
                       (real)R(0.0));
    c = leave_inertial_force(t, l, k, &now.moves, &c, h);
    store_work(l.exists, t, l.k, (uint)WORK_START, now.start);
  }
  store_root(has_links(t), t, (uint)ROOT_START, load_root(t, (uint)ROOT_LINEAR_VELOCITY));
  *energy = sum;
}

/* What a round reads of a link: a further one the velocity that its joint returns to, the last one the armature. */
typedef struct {
  settling_joint joint;
  solid_link solid;
  vec4 start;
  real armature;
} rounding_link;

SHARED void load_further_round(const articulation *t, tree_link l, rounding_link *r)
{
  load_settling_joint(t, l, &r->joint);
  r->solid = load_solid_link(t, l);
  r->start = load_work(t, l.k, (uint)WORK_START);
  r->armature = R(0.0);
}
SHARED void load_last_round(const articulation *t, tree_link l, rounding_link *r)
{
  load_settling_joint(t, l, &r->joint);
  r->solid = load_solid_link(t, l);
  r->start = extend(zero3(), R(0.0));
  r->armature = armature_of_link(t, l);
}

/* The velocity that the pushes lead to, of link k; numbers: of its joint. before: link k - 1. */
SHARED settled_link settle_and_move_link(const articulation *t, tree_link l, uint k, const settling_joint *of,
                                         const settled_link *before, vec3 *numbers)
{
  settled_link r = *before;
  settled_joint s = settle_joint(t, l, of, motion_of_parent(t, l, k, before->change, (uint)WORK_CHANGE));
  spatial_motion parent = motion_of_parent(t, l, k, before->velocity, (uint)WORK_VELOCITY);
  *numbers = s.numbers;
  r.change = s.change;
  r.velocity = link_velocity(l, of->joint.joint, vector_of_numbers(l, of->joint.joint.frame, s.numbers),
                             linear_velocity_of_root(t, l), parent);
  store_motion(l.exists, t, l.k, (uint)WORK_VELOCITY, r.velocity);
  return r;
}

/* The forces of a further round, at the velocities that the last one has led to. */
CALLED void begin_round(const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  settled_link r = resting_ground();
  circling_link c = circling_ground();
  BEGIN_WALK(rounding_link, load_further_round, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(rounding_link, load_further_round, t, k, k + 1u);
    circling_record moves = {now.joint.joint.joint, now.solid, no_motion(), zero3()};
    r = settle_and_move_link(t, l, k, &now.joint, &r, &moves.numbers);
    moves.velocity = r.velocity;
    c = leave_inertial_force(t, l, k, &moves, &c, h);
    store_state(l.exists, t, l.k, (uint)STATE_JOINT_VELOCITY, now.start);
  }
  store_root(has_links(t), t, (uint)ROOT_LINEAR_VELOCITY, load_root(t, (uint)ROOT_START));
}

CALLED void end_first_half(const articulation *tree, vec3 frame, real *energy)
{
  articulation own = *tree;
  const articulation *t = &own;
  real sum = R(0.0);
  settled_link r = resting_ground();
  BEGIN_WALK(rounding_link, load_last_round, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(rounding_link, load_last_round, t, k, k + 1u);
    vec3 numbers;
    r = settle_and_move_link(t, l, k, &now.joint, &r, &numbers);
    sum = sum + choose(l.exists, energy_of_link(&now.solid, r.velocity, numbers, now.armature, frame), (real)R(0.0));
  }
  *energy = sum;
}

/* The velocities of all joints and links, after half of the inertial forces at the velocity that this leads to; the
 * energy before and after. */
SHARED real first_half(const articulation *t, real h, conserved *kept)
{
  real energy;
  begin_first_half(t, R(0.5) * h, kept->drift, &kept->energy);
  push_links(t);
  for (uint round = 1u; round < FREE_MOTION_ROUNDS; ++round) {
    begin_round(t, R(0.5) * h);
    push_links(t);
  }
  end_first_half(t, kept->drift, &energy);
  return energy;
}

/* --- the next configuration ----------------------------------------------------------------------------------- */
/* Link k where its joint is. before: link k - 1. */
SHARED standing_link place_and_weigh_link(const articulation *t, tree_link l, uint k, const link_constants *constants,
                                          standing_link before, vec4 position, vec3 numbers)
{
  standing_link own = place_link(t, l, constants, standing_parent(t, l, k, before), position, numbers);
  solid_link solid = {rotation_of(own.orientation), xyz(constants->moments), constants->frame_b.w};
  store_symmetric6(l.exists, t, l.k, inertia_of_solid(solid));
  return own;
}

/* What a walk that places the links reads of one. */
typedef struct {
  link_constants constants;
  vec4 position, numbers; /* of the joint and of its velocity */
} placing_link;

SHARED void load_placing_link(const articulation *t, tree_link l, placing_link *p)
{
  p->constants = load_link_constants(t, l);
  p->position = load_state(t, l.k, (uint)STATE_JOINT_POSITION);
  p->numbers = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY);
}

/* The links where their joints are, and what they answer to impulses there. */
SHARED void prepare_tree(const articulation *t, real h)
{
  standing_link s = standing_ground();
  BEGIN_WALK(placing_link, load_placing_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(placing_link, load_placing_link, t, k, k + 1u);
    now.constants.inertia = implicit_inertia_of(&now.constants, h);
    s = place_and_weigh_link(t, l, k, &now.constants, s, now.position, xyz(now.numbers));
  }
  factor_tree(t);
  invert_link_inertias(t);
}

/* The same after the joints have moved on; the centre of mass, from that of the root. */
CALLED void advance_links(const articulation *tree, real h, mass_moment *masses)
{
  articulation own = *tree;
  const articulation *t = &own;
  mass_moment sum = {R(0.0), zero3()};
  standing_link s = standing_ground();
  BEGIN_WALK(placing_link, load_placing_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(placing_link, load_placing_link, t, k, k + 1u);
    vec3 numbers = xyz(now.numbers);
    now.constants.inertia = implicit_inertia_of(&now.constants, h);
    s = place_and_weigh_link(t, l, k, &now.constants, s, advance_joint(t, l, now.position, numbers, h), numbers);
    sum = with_mass_of_link(sum, l, now.constants.frame_b.w, s.offset);
  }
  *masses = sum;
}

/* The centre of mass of a free tree moves straight, whatever the root does beside it. */
SHARED vec3 way_missed_by_center(const articulation *t, conserved before, vec3 center, vec3 way_of_root, real h)
{
  vec3 moved = add(way_of_root, subtract(center, before.center));
  return choose3(tree_link_of(t, 0u).is_free, subtract(scale(before.drift, h), moved), zero3());
}
SHARED void move_root_by(const articulation *t, vec3 way)
{
  mask free = tree_link_of(t, 0u).is_free & has_links(t);
  double_float3 at = moved_position(root_position(t), way);
  store_root(free, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(free, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
}

/* --- the second half ------------------------------------------------------------------------------------------ */
/* What its first walk reads of a link. */
typedef struct {
  circling_record moves;
  single_factor single;
} inverting_link;

SHARED void load_inverting_link(const articulation *t, tree_link l, inverting_link *i)
{
  load_circling_record(t, l, &i->moves);
  i->single = load_single_factor(t, l);
}

CALLED void begin_second_half(const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  symmetric6 w = zero_symmetric6();
  circling_link c = circling_ground();
  BEGIN_WALK(inverting_link, load_inverting_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(inverting_link, load_inverting_link, t, k, k + 1u);
    factored_joint f = {now.moves.joint, now.single};
    w = invert_link_inertia(t, l, &f, k, &w);
    c = leave_inertial_force(t, l, k, &now.moves, &c, h);
  }
}

/* What the last walk reads of a link. */
typedef struct {
  settling_link link;
  solid_link solid;
  vec3 offset;
} ending_link;

SHARED void load_ending_link(const articulation *t, tree_link l, ending_link *e)
{
  load_settling_link(t, l, &e->link);
  e->solid = load_solid_link(t, l);
  e->offset = xyz(load_work(t, l.k, (uint)WORK_OFFSET));
}

/* Free trees as one body then. */
CALLED void end_second_half(const articulation *tree, whole_tree *whole)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask free = tree_link_of(t, 0u).is_free & has_links(t);
  whole_tree sum = {zero_symmetric6(), no_force()};
  settled_link s = resting_ground();
  BEGIN_WALK(ending_link, load_ending_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(ending_link, load_ending_link, t, k, k + 1u);
    s = settle_link(t, l, k, &now.link, &s);
    if (any_of(free)) sum = with_link(sum, l, &now.solid, now.offset, s.velocity);
  }
  *whole = sum;
}

SHARED whole_tree second_half(const articulation *t, real h)
{
  whole_tree whole;
  begin_second_half(t, R(0.5) * h);
  push_links(t);
  end_second_half(t, &whole);
  return whole;
}

/* The rounds did not converge if half a substep, which should change next to nothing of the energy, changes so much.
 * With 0.02, robots that thrash skipped the first half in many steps of 5 ms, and were twice as far from a run that had
 * converged after 0.2 s; trees that turn by 100 rad/s want less than 0.1. */
#define LARGEST_CHANGE_IN_HALF R(0.05)

SHARED void move_tree_freely(const articulation *t, real h)
{
  conserved kept = momentum_of_tree(t);
  real energy = first_half(t, h, &kept);
  mask fast = has_changed_energy(t, kept, energy, LARGEST_CHANGE_IN_HALF);
  if (any_of(fast)) return_velocities_if(fast, t);
  vec3 way = scale(root_velocity(t), h); /* of the root; a difference of positions would depend on where the tree is */
  mass_moment masses;
  advance_links(t, h, &masses);
  factor_tree(t);
  vec3 missed = way_missed_by_center(t, kept, scale(masses.moment, kept.inverse_mass), way, h);
  move_root_by(t, missed);
  kept.momentum = force_at(kept.momentum, add(way, missed));
  conserve(t, kept, second_half(t, h));
}

#endif
