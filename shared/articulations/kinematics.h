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

/* h: of the substep, of which drives.h knows why. The parent has its place. */
SHARED void place_link(const articulation *t, tree_link l, real h)
{
  vec4 frame_a = load_link(t, l.k, (uint)LINK_FRAME_A), frame_b = load_link(t, l.k, (uint)LINK_FRAME_B);
  quat parent = quat_from(
      choose4(l.is_root, make_vec4(R(0.0), R(0.0), R(0.0), R(1.0)), load_work(t, l.parent, (uint)WORK_ORIENTATION)));
  quat a = quat_multiply(parent, quat_from(load_link(t, l.k, (uint)LINK_FRAME_A_ORIENTATION)));
  vec4 position = load_state(t, l.k, (uint)STATE_JOINT_POSITION);
  quat b = quat_multiply(a, joint_rotation(l, position));
  quat own = quat_normalized(quat_multiply(b, conjugate(quat_from(load_link(t, l.k, (uint)LINK_FRAME_B_ORIENTATION)))));
  vec3 axis = axis_x(rotation_of(a)), from_parent = rotate(rotation_of(parent), xyz(frame_a));
  if (any_of(l.is_slider)) from_parent = choose3(l.is_slider, add_scaled(from_parent, axis, position.x), from_parent);
  vec3 to_center = negate(rotate(rotation_of(own), xyz(frame_b)));
  vec3 start = choose3(l.is_root, zero3(), xyz(load_work(t, l.parent, (uint)WORK_OFFSET)));
  real inertia = implicit_inertia_of(t, l, frame_a.w, load_link(t, l.k, (uint)LINK_MOMENTS).w, h);
  store_work(l.exists, t, l.k, (uint)WORK_ORIENTATION, quat_to_vec4(own));
  store_work(l.exists, t, l.k, (uint)WORK_OFFSET, extend(add(start, add(from_parent, to_center)), R(0.0)));
  store_work(l.exists, t, l.k, (uint)WORK_FROM_PARENT, extend(from_parent, R(0.0)));
  store_work(l.exists, t, l.k, (uint)WORK_TO_CENTER, extend(to_center, inertia));
  store_work(l.exists, t, l.k, (uint)WORK_FRAME, choose4(l.is_ball, quat_to_vec4(a), extend(axis, R(0.0))));
}

SHARED vec3 joint_velocity_in_world(const articulation *t, tree_link l, vec4 frame)
{
  return vector_of_numbers(l, frame, xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY)));
}

/* The velocity of the link, at its centre. */
SHARED spatial_motion link_velocity(const articulation *t, tree_link l, placed_joint j)
{
  spatial_motion at_b = motion_at(load_parent_motion(t, l, (uint)WORK_VELOCITY), j.from_parent);
  spatial_motion own =
      joint_motion(l, joint_velocity_in_world(t, l, j.frame), xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)));
  at_b.angular = add(at_b.angular, own.angular);
  at_b.linear = add(at_b.linear, own.linear);
  return motion_at(at_b, j.to_center);
}

/* Of a link whose parent moves already. */
SHARED void move_link(const articulation *t, tree_link l)
{
  store_motion(l.exists, t, l.k, (uint)WORK_VELOCITY, link_velocity(t, l, load_placed_joint(t, l)));
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
