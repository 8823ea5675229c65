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

/* What inertial forces follow from, of a link whose joint moves with constant speed. numbers: of that speed. */
typedef struct {
  placed_joint joint;
  solid_link solid;
  spatial_motion velocity;
  vec3 numbers;
} circling_record;

SHARED void load_circling_record(const articulation *t, tree_link l, circling_record *c)
{
  c->joint = load_placed_joint(t, l);
  c->solid = load_solid_link(t, l);
  c->velocity = load_motion(t, l.k, (uint)WORK_VELOCITY);
  c->numbers = load_joint_velocity(t, l);
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

/* The acceleration of a link; own: the relative acceleration that the joint gives, 0 if its velocity stays. */
SHARED spatial_motion link_acceleration(tree_link l, const circling_record *c, const circling_link *parent,
                                        spatial_motion own)
{
  vec3 turning = parent->velocity.angular;
  placed_joint j = c->joint;
  spatial_motion rate = joint_motion(l, vector_of_numbers(l, j.frame, c->numbers), zero3());
  rate.angular = choose3(l.is_free, zero3(), rate.angular);
  spatial_motion at_b = motion_at(parent->acceleration, j.from_parent);
  at_b.linear = add(at_b.linear, circling(turning, j.from_parent));
  at_b.linear = add_scaled(at_b.linear, cross3(turning, rate.linear), R(2.0));
  at_b.angular = add(at_b.angular, cross3(turning, rate.angular));
  spatial_motion m = motion_at(add_motions(at_b, own), j.to_center);
  m.linear = add(m.linear, circling(c->velocity.angular, j.to_center));
  return m;
}

/* What a link needs to accelerate so while it turns. */
SHARED spatial_force force_to_accelerate(const circling_record *c, spatial_motion acceleration)
{
  vec3 w = c->velocity.angular;
  spatial_force f = {add(moments_times(&c->solid, acceleration.angular), cross3(w, moments_times(&c->solid, w))),
                     scale(acceleration.linear, c->solid.mass)};
  return f;
}

/* row: of accelerations. */
SHARED circling_link circling_parent(const articulation *t, tree_link l, uint k, const circling_link *before, uint row)
{
  circling_link parent = {motion_of_parent(t, l, k, before->velocity, (uint)WORK_VELOCITY),
                          motion_of_parent(t, l, k, before->acceleration, row)};
  return parent;
}

/* Leaves in WORK_FORCE the impulse over h by which link k changes its joint's velocity if nothing else pushes, and says
 * how it accelerates. before: link k - 1; nothing is pending yet. */
SHARED circling_link leave_inertial_force(const articulation *t, tree_link l, uint k, const circling_record *c,
                                          const circling_link *before, real h)
{
  circling_link parent = circling_parent(t, l, k, before, (uint)WORK_ACCELERATION);
  circling_link own = {c->velocity, link_acceleration(l, c, &parent, no_motion())};
  store_motion(l.exists, t, l.k, (uint)WORK_ACCELERATION, own.acceleration);
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, scaled_force(force_to_accelerate(c, own.acceleration), -h));
  return own;
}

CALLED void load_inertial_forces(const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  circling_link c = circling_ground();
  BEGIN_WALK(circling_record, load_circling_record, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(circling_record, load_circling_record, t, k, k + 1u);
    c = leave_inertial_force(t, l, k, &now, &c, h);
  }
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
