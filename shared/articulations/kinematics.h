/* kinematics.h - forward kinematics: from the coordinates of the joints to the poses and velocities of the links.
 *
 *     (parent's centre) ---from_parent---> frame b ---to_center---> (link's centre)
 *
 * Frame b of a joint is the point about which it turns. A slider takes it along the axis x of frame a.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_KINEMATICS_H
#define TANDEM_SHARED_ARTICULATIONS_KINEMATICS_H

#include "shared/articulations/drives.h"
#include "shared/records.h"

SHARED quat conjugate(quat q) { return make_quat(-q.x, -q.y, -q.z, q.w); }

/* Frame b in axes of frame a. Whole turns are taken off the angle first, where it is still exact. */
SHARED quat joint_rotation(tree_link l, vec4 position)
{
  quat turn = quat_from(choose4(l.is_ball | l.is_free, position, make_vec4(R(0.0), R(0.0), R(0.0), R(1.0))));
  if (any_of(l.is_hinge)) {
    real turns = nearest_integer(position.x / (R(2.0) * HALF_TURN));
    angle_functions f = sine_cosine(R(0.5) * (position.x - turns * R(6.28318530717958648)));
    turn = quat_from(choose4(l.is_hinge, make_vec4(f.sine, R(0.0), R(0.0), f.cosine), quat_to_vec4(turn)));
  }
  return turn;
}

/* A link where it stands, and how it moves. offset: of its centre from ROOT_POSITION. */
typedef struct {
  quat orientation;
  vec3 offset;
  spatial_motion velocity;
} standing_link;

SHARED standing_link standing_ground(void)
{
  standing_link g = {make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), zero3(), no_motion()};
  return g;
}
SHARED standing_link choose_standing_link(mask m, standing_link a, standing_link b)
{
  standing_link s = {quat_from(choose4(m, quat_to_vec4(a.orientation), quat_to_vec4(b.orientation))),
                     choose3(m, a.offset, b.offset), choose_motion(m, a.velocity, b.velocity)};
  return s;
}
SHARED standing_link load_standing_link(const articulation *t, shape_uint k)
{
  standing_link s = {quat_from(load_work(t, k, (uint)WORK_ORIENTATION)), xyz(load_work(t, k, (uint)WORK_OFFSET)),
                     load_motion(t, k, (uint)WORK_VELOCITY)};
  return s;
}
/* before: link k - 1. */
SHARED standing_link standing_parent(const articulation *t, tree_link l, uint k, standing_link before)
{
  mask follows = follows_at_once(l, k);
  if (!any_of(!follows)) return before;
  standing_link loaded = choose_standing_link(l.is_root, standing_ground(), load_standing_link(t, l.parent));
  return choose_standing_link(follows, before, loaded);
}

/* The velocity of the link, at its centre. world: of the joint; linear: of a free root. */
SHARED spatial_motion link_velocity(tree_link l, placed_joint j, vec3 world, vec3 linear, spatial_motion parent)
{
  spatial_motion at_b = motion_at(parent, j.from_parent), own = joint_motion(l, world, linear);
  at_b.angular = add(at_b.angular, own.angular);
  at_b.linear = add(at_b.linear, own.linear);
  return motion_at(at_b, j.to_center);
}
SHARED vec3 linear_velocity_of_root(const articulation *t, tree_link l)
{
  return any_of(l.is_free) ? xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)) : zero3();
}

SHARED placed_joint place_joint(tree_link l, const link_constants *c, vec4 position, quat parent, quat a, quat own)
{
  placed_joint j;
  vec3 axis = axis_x(rotation_of(a));
  j.from_parent = rotate(rotation_of(parent), xyz(c->frame_a));
  if (any_of(l.is_slider))
    j.from_parent = choose3(l.is_slider, add_scaled(j.from_parent, axis, position.x), j.from_parent);
  j.to_center = negate(rotate(rotation_of(own), xyz(c->frame_b)));
  j.frame = choose4(l.is_ball, quat_to_vec4(a), extend(axis, R(0.0)));
  j.implicit_inertia = c->inertia;
  return j;
}

/* position, numbers: of the joint and of its velocity. */
SHARED standing_link place_link(const articulation *t, tree_link l, const link_constants *c, standing_link parent,
                                vec4 position, vec3 numbers)
{
  vec3 linear = linear_velocity_of_root(t, l);
  quat a = quat_multiply(parent.orientation, quat_from(c->orientation_a)),
       b = quat_multiply(a, joint_rotation(l, position));
  standing_link own;
  own.orientation = quat_normalized(quat_multiply(b, conjugate(quat_from(c->orientation_b))));
  placed_joint j = place_joint(l, c, position, parent.orientation, a, own.orientation);
  own.offset = add(parent.offset, add(j.from_parent, j.to_center));
  own.velocity = link_velocity(l, j, vector_of_numbers(l, j.frame, numbers), linear, parent.velocity);
  store_work(l.exists, t, l.k, (uint)WORK_ORIENTATION, quat_to_vec4(own.orientation));
  store_work(l.exists, t, l.k, (uint)WORK_OFFSET, extend(own.offset, R(0.0)));
  store_work(l.exists, t, l.k, (uint)WORK_FROM_PARENT, extend(j.from_parent, R(0.0)));
  store_work(l.exists, t, l.k, (uint)WORK_TO_CENTER, extend(j.to_center, j.implicit_inertia));
  store_work(l.exists, t, l.k, (uint)WORK_FRAME, j.frame);
  store_motion(l.exists, t, l.k, (uint)WORK_VELOCITY, own.velocity);
  return own;
}

SHARED vec3 load_joint_velocity(const articulation *t, tree_link l)
{
  return xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY));
}

SHARED double_float3 root_position(const articulation *t)
{
  double_float3 p = {xyz(load_root(t, (uint)ROOT_POSITION)), xyz(load_root(t, (uint)ROOT_POSITION + 1u))};
  return p;
}
/* The centre of a link. */
SHARED double_float3 link_position(const articulation *t, shape_uint k)
{
  return moved_position(root_position(t), xyz(load_work(t, k, (uint)WORK_OFFSET)));
}

#endif
