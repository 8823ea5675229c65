/* joint_groups.cpp - finds the frame of which several joints are the axes; see joint_groups.h. */
#include "host/io/articulated/joint_groups.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr double right_angle = 1e-3; /* cosine: axes written with four digits are at right angles */

using JointKind = LinkJoint::Kind;

/* The axis the other way round. */
JointAxis reversed(JointAxis axis)
{
  std::swap(axis.lower, axis.upper);
  for (float *x : {&axis.lower, &axis.upper, &axis.target_position, &axis.target_velocity, &axis.force}) *x = 0 - *x;
  return axis;
}

/* The point halfway between two lines where they are nearest, and how far they pass each other. */
struct Crossing {
  Vector at;
  double gap;
};
Crossing crossing_of(const LinkJoint &first, const LinkJoint &second)
{
  const Vector apart = second.at - first.at;
  if (apart.squared_norm() == 0) return {first.at, 0};
  const double cosine = first.axis.dot(second.axis), sine_squared = 1 - cosine * cosine;
  const double on_first = (apart.dot(first.axis) - cosine * apart.dot(second.axis)) / sine_squared;
  const double on_second = (cosine * apart.dot(first.axis) - apart.dot(second.axis)) / sine_squared;
  const Vector p = first.at + on_first * first.axis, q = second.at + on_second * second.axis;
  return {0.5 * (p + q), (q - p).norm()};
}

bool are_across(std::span<const LinkJoint> joints)
{
  for (size_t i = 0; i < joints.size(); ++i)
    for (size_t k = i + 1; k < joints.size(); ++k)
      if (std::abs(joints[i].axis.dot(joints[k].axis)) > right_angle) return false;
  return true;
}

GroupedJoint alone(const LinkJoint &single)
{
  GroupedJoint result;
  Joint &joint = result.joint;
  result.frame = {single.at, rotation_of_axes(single.axis, any_across(single.axis))};
  if (single.kind == JointKind::hinge) joint.type = JointType::hinge;
  if (single.kind == JointKind::slide) joint.type = JointType::slider;
  if (single.kind == JointKind::ball) joint.rotations.fill(single.settings);
  else {
    (single.kind == JointKind::hinge ? joint.rotations : joint.directions)[0] = single.settings;
    result.axes = {{single.kind == JointKind::hinge ? 3u : 0u, false}};
  }
  return result;
}

/* The axis of the frame along which a joint's is; nothing if there is none. */
std::optional<GroupedAxis> along_axis(const RigidFrame &frame, const LinkJoint &joint)
{
  const Matrix axes = rotation_matrix(frame.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const double cosine = joint.axis.dot(axes.column(axis));
    if (std::abs(cosine) > 1 - right_angle * right_angle) return GroupedAxis{size_t(axis), cosine < 0};
  }
  return {};
}

Rotation axes_of_group(std::span<const LinkJoint> slides, std::span<const LinkJoint> hinges)
{
  const Vector x = hinges.empty() ? slides.front().axis : hinges.back().axis;
  if (hinges.size() > 1) return rotation_of_axes(x, hinges.front().axis);
  for (const LinkJoint &slide : slides)
    if (std::abs(slide.axis.dot(x)) < 0.5) return rotation_of_axes(x, slide.axis);
  return rotation_of_axes(x, any_across(x));
}

bool place_axes(std::span<const LinkJoint> joints, GroupedJoint &group)
{
  Axes free_directions, free_rotations;
  for (const LinkJoint &joint : joints) {
    const std::optional<GroupedAxis> along = along_axis(group.frame, joint);
    if (!along) return false;
    const bool turns = joint.kind == JointKind::hinge;
    Axes &is_free = turns ? free_rotations : free_directions;
    (along->axis == 0 ? is_free.x : along->axis == 1 ? is_free.y : is_free.z) = true;
    (turns ? group.joint.rotations : group.joint.directions)[along->axis] =
        along->reversed ? reversed(joint.settings) : joint.settings;
    group.axes.push_back({along->axis + (turns ? 3 : 0), along->reversed});
  }
  group.joint.type = JointType::six_dof;
  group.joint.held_directions = {!free_directions.x, !free_directions.y, !free_directions.z};
  group.joint.held_rotations = {!free_rotations.x, !free_rotations.y, !free_rotations.z};
  return true;
}

/* False if an axis passes the others farther than is bridged. */
bool place_crossing(std::span<const LinkJoint> hinges, double reach, GroupedJoint &group)
{
  const Crossing outer = crossing_of(hinges.front(), hinges.back());
  group.frame.position = outer.at;
  group.gap = outer.gap;
  for (const LinkJoint &hinge : hinges) {
    const Vector apart = outer.at - hinge.at;
    const double beside = hinges.size() < 3 ? 0 : (apart - apart.dot(hinge.axis) * hinge.axis).norm();
    group.gap = std::max(group.gap, 2 * beside);
  }
  return group.gap <= reach;
}

} // namespace

std::optional<GroupedJoint> group_joints(std::span<const LinkJoint> joints, double reach)
{
  if (joints.size() == 1) return alone(joints.front());
  const auto is_slide = [](const LinkJoint &joint) { return joint.kind == JointKind::slide; };
  const auto first_hinge = size_t(std::find_if_not(joints.begin(), joints.end(), is_slide) - joints.begin());
  const std::span<const LinkJoint> slides = joints.first(first_hinge), hinges = joints.subspan(first_hinge);
  for (const LinkJoint &joint : hinges)
    if (joint.kind != JointKind::hinge) return {};
  if (slides.size() > 3 || hinges.size() > 3 || !are_across(slides) || !are_across(hinges)) return {};
  GroupedJoint group;
  group.frame.rotation = axes_of_group(slides, hinges);
  group.frame.position = hinges.empty() ? slides.back().at : hinges.back().at;
  if (hinges.size() > 1 && !place_crossing(hinges, reach, group)) return {};
  if (!place_axes(joints, group)) return {};
  return group;
}

} // namespace tandem
