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

/* The acceleration of a link; own: the relative acceleration that the joint gives, 0 if its velocity stays. */
SHARED spatial_motion link_acceleration(const articulation *t, tree_link l, placed_joint j, spatial_motion parent,
                                        spatial_motion own)
{
  spatial_motion of_parent = load_parent_motion(t, l, (uint)WORK_VELOCITY), of_link;
  of_link = load_motion(t, l.k, (uint)WORK_VELOCITY);
  vec3 world = joint_velocity_in_world(t, l, j.frame);
  spatial_motion rate = joint_motion(l, world, zero3());
  rate.angular = choose3(l.is_free, zero3(), rate.angular);
  spatial_motion at_b = motion_at(parent, j.from_parent);
  at_b.linear = add(at_b.linear, circling(of_parent.angular, j.from_parent));
  at_b.linear = add_scaled(at_b.linear, cross3(of_parent.angular, rate.linear), R(2.0));
  at_b.angular = add(at_b.angular, cross3(of_parent.angular, rate.angular));
  at_b.angular = add(at_b.angular, own.angular);
  at_b.linear = add(at_b.linear, own.linear);
  spatial_motion m = motion_at(at_b, j.to_center);
  m.linear = add(m.linear, circling(of_link.angular, j.to_center));
  return m;
}

/* A principal inertia times a vector of the world. */
SHARED vec3 moments_times(const articulation *t, tree_link l, vec3 v)
{
  mat3 r = rotation_of(quat_from(load_work(t, l.k, (uint)WORK_ORIENTATION)));
  return rotate(r, multiply(xyz(load_link(t, l.k, (uint)LINK_MOMENTS)), rotate_back(r, v)));
}
SHARED real mass_of_link(const articulation *t, tree_link l) { return load_link(t, l.k, (uint)LINK_FRAME_B).w; }

/* What a link needs to accelerate so while it turns. */
SHARED spatial_force force_to_accelerate(const articulation *t, tree_link l, spatial_motion acceleration)
{
  vec3 w = load_motion(t, l.k, (uint)WORK_VELOCITY).angular;
  spatial_force f = {add(moments_times(t, l, acceleration.angular), cross3(w, moments_times(t, l, w))),
                     scale(acceleration.linear, mass_of_link(t, l))};
  return f;
}

/* Leaves in WORK_FORCE the impulses over h by which the links change their joints' velocities if nothing else pushes,
 * and no impulses of joints. Of a link whose parent has them. */
SHARED void load_inertial_force(const articulation *t, tree_link l, real h)
{
  spatial_motion a =
      link_acceleration(t, l, load_placed_joint(t, l), load_parent_motion(t, l, (uint)WORK_CHANGE), no_motion());
  store_motion(l.exists, t, l.k, (uint)WORK_CHANGE, a);
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, scaled_force(force_to_accelerate(t, l, a), -h));
  store_force(l.exists, t, l.k, (uint)WORK_PENDING, no_force());
}
CALLED void load_inertial_forces(const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0; k < t->most_links; ++k) load_inertial_force(t, tree_link_of(t, k), h);
}

SHARED spatial_force outer_force(const articulation *t, tree_link l, vec3 gravity)
{
  spatial_force f = {xyz(load_state(t, l.k, (uint)STATE_MOMENT)), xyz(load_state(t, l.k, (uint)STATE_FORCE))};
  f.force = add_scaled(f.force, gravity, mass_of_link(t, l));
  return f;
}
SHARED spatial_force force_of_free_joint(const articulation *t, tree_link l)
{
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

/* Leaves in WORK_FORCE and WORK_PENDING the impulses over h of gravity, outer forces and drives, and the warm start. */
SHARED void load_outer_forces(const articulation *t, vec3 gravity, real h)
{
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    spatial_force f = add_forces(outer_force(t, l, gravity), force_of_free_joint(t, l));
    store_force(l.exists, t, l.k, (uint)WORK_FORCE, scaled_force(f, h));
    vec3 push = scale(force_of_joint(t, l, h), h);
    push.x = push.x + warm_start_of(t, l);
    if (any_of(l.is_ball))
      push = choose3(l.is_ball, vector_of_numbers(l, load_work(t, l.k, (uint)WORK_FRAME), push), push);
    spatial_force pending = {push, zero3()};
    store_force(l.exists, t, l.k, (uint)WORK_PENDING, pending);
  }
}

/* The velocities after h of gravity, outer forces and drives; the tree is factored. */
SHARED void accelerate_tree(const articulation *t, vec3 gravity, real h)
{
  load_outer_forces(t, gravity, h);
  push_all_links(t);
  settle_tree(t);
}

#endif
