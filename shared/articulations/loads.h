/* loads.h - the forces on the links and joints of a tree: gravity, what pushes from outside, drives, and the forces by
 * which links keep turning and circling (gyroscopic, centrifugal and Coriolis forces).
 *
 * The latter are what the links would need to move as they do while the velocities of all joints stay as they are
 * (recursive Newton-Euler, outward; Luh, Walker and Paul, "On-line computational scheme for mechanical manipulators",
 * 1980). Accelerations here are those of the centres as seen from the world.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_LOADS_H
#define TANDEM_SHARED_ARTICULATIONS_LOADS_H

#include "shared/articulations/respond.h"

/* Where a link is, moved from frame b: the acceleration of a point of a body that turns. */
SHARED vec3 circling(vec3 angular, vec3 arm) { return cross3(angular, cross3(angular, arm)); }

/* What turns and circles, of a link whose joint moves with constant speed. numbers: of that speed. */
typedef struct {
  spatial_motion parent, own; /* velocities */
  vec3 numbers;
} moving_link;

/* The acceleration of a link; parent: that of its parent; own: the relative acceleration that the joint gives, 0 if its
 * velocity stays. */
SHARED spatial_motion link_acceleration(tree_link l, placed_joint j, const moving_link *moves, spatial_motion parent,
                                        spatial_motion own)
{
  vec3 turning = moves->parent.angular;
  spatial_motion rate = joint_motion(l, vector_of_numbers(l, j.frame, moves->numbers), zero3());
  rate.angular = choose3(l.is_free, zero3(), rate.angular);
  spatial_motion at_b = motion_at(parent, j.from_parent);
  at_b.linear = add(at_b.linear, circling(turning, j.from_parent));
  at_b.linear = add_scaled(at_b.linear, cross3(turning, rate.linear), R(2.0));
  at_b.angular = add(at_b.angular, cross3(turning, rate.angular));
  spatial_motion m = motion_at(add_motions(at_b, own), j.to_center);
  m.linear = add(m.linear, circling(moves->own.angular, j.to_center));
  return m;
}

/* What a link needs to accelerate so while it turns with the angular velocity w. */
SHARED spatial_force force_to_accelerate(const solid_link *s, vec3 w, spatial_motion acceleration)
{
  spatial_force f = {add(moments_times(s, acceleration.angular), cross3(w, moments_times(s, w))),
                     scale(acceleration.linear, s->mass)};
  return f;
}

/* Leaves in WORK_FORCE the impulse over h by which the link changes its joint's velocity if nothing else pushes, and
 * says how it accelerates. parent: how its parent does; nothing is pending yet. */
SHARED spatial_motion leave_inertial_force(const articulation *t, tree_link l, placed_joint j, const solid_link *solid,
                                           const moving_link *moves, spatial_motion parent, real h)
{
  spatial_motion a = link_acceleration(l, j, moves, parent, no_motion());
  store_motion(l.exists, t, l.k, (uint)WORK_ACCELERATION, a);
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, scaled_force(force_to_accelerate(solid, moves->own.angular, a), -h));
  return a;
}

/* What a walk that finds inertial forces knows of a link. */
typedef struct {
  spatial_motion velocity, acceleration;
} circling_link;

SHARED circling_link circling_ground(void)
{
  circling_link g = {no_motion(), no_motion()};
  return g;
}

/* Of link k, which moves as WORK_VELOCITY says. before: of link k - 1. */
SHARED circling_link load_inertial_force(const articulation *t, tree_link l, uint k, const circling_link *before,
                                         real h)
{
  placed_joint j = load_placed_joint(t, l);
  solid_link solid = load_solid_link(t, l);
  moving_link moves = {motion_of_parent(t, l, k, before->velocity, (uint)WORK_VELOCITY),
                       load_motion(t, l.k, (uint)WORK_VELOCITY), load_joint_velocity(t, l)};
  spatial_motion parent = motion_of_parent(t, l, k, before->acceleration, (uint)WORK_ACCELERATION);
  circling_link c = {moves.own, leave_inertial_force(t, l, j, &solid, &moves, parent, h)};
  return c;
}
CALLED void load_inertial_forces(const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  circling_link c = circling_ground();
  for (uint k = 0; k < t->most_links; ++k) c = load_inertial_force(t, tree_link_of(t, k), k, &c, h);
}

SHARED real mass_of_link(const articulation *t, tree_link l) { return load_link(t, l.k, (uint)LINK_FRAME_B).w; }

SHARED spatial_force load_outside_force(const articulation *t, tree_link l)
{
  spatial_force f = {xyz(load_state(t, l.k, (uint)STATE_MOMENT)), xyz(load_state(t, l.k, (uint)STATE_FORCE))};
  return f;
}
SHARED spatial_force with_weight(const articulation *t, tree_link l, spatial_force f, vec3 gravity)
{
  spatial_force sum = {f.moment, add_scaled(f.force, gravity, mass_of_link(t, l))};
  return sum;
}
SHARED spatial_force outer_force(const articulation *t, tree_link l, vec3 gravity)
{
  return with_weight(t, l, load_outside_force(t, l), gravity);
}
SHARED spatial_force force_of_free_joint(const articulation *t, tree_link l)
{
  if (!any_of(l.is_free)) return no_force();
  spatial_force f = {xyz(load_state(t, l.k, (uint)STATE_JOINT_FORCE)), xyz(load_root(t, (uint)ROOT_LINEAR_FORCE))};
  return choose_force(l.is_free, f, no_force());
}

/* The force of a joint, with that of its implicit drive. */
SHARED vec3 force_of_joint(const articulation *t, tree_link l, real h)
{
  vec3 given = xyz(load_state(t, l.k, (uint)STATE_JOINT_FORCE));
  vec3 drive = implicit_drive_force(t, l, load_state(t, l.k, (uint)STATE_JOINT_POSITION),
                                    xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY)), h);
  return choose3(l.is_free, zero3(), add(given, drive));
}

/* What the rows of the last substep gave the joint (rows.h), with which this one starts. */
SHARED real warm_start_of(const articulation *t, tree_link l)
{
  vec4 kept = load_state(t, l.k, (uint)STATE_ROW_IMPULSE);
  return choose(has_one_freedom(l), (kept.x + kept.y) + kept.z, (real)R(0.0));
}

/* Leaves in WORK_FORCE and WORK_PENDING the impulses over h of outer forces and drives, and the warm start. outer: with
 * gravity. */
SHARED void load_forces_of_link(const articulation *t, tree_link l, spatial_force outer, real h)
{
  spatial_force impulse = scaled_force(add_forces(outer, force_of_free_joint(t, l)), h);
  vec3 push = scale(force_of_joint(t, l, h), h);
  push.x = push.x + warm_start_of(t, l);
  if (any_of(l.is_ball))
    push = choose3(l.is_ball, vector_of_numbers(l, load_work(t, l.k, (uint)WORK_FRAME), push), push);
  spatial_force pending = {push, zero3()};
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, impulse);
  store_force(l.exists, t, l.k, (uint)WORK_PENDING, pending);
}
SHARED void load_outer_forces(const articulation *t, vec3 gravity, real h)
{
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    load_forces_of_link(t, l, outer_force(t, l, gravity), h);
  }
}

/* The velocities after h of gravity, outer forces and drives; the tree is factored. */
SHARED void accelerate_tree(const articulation *t, vec3 gravity, real h)
{
  load_outer_forces(t, gravity, h);
  push_links_and_joints(t);
  settle_tree(t);
}

#endif
