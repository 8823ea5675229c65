/* joint_error.cpp - how far joints are open, from the poses of their bodies, in double; see tandem/metrics.h. */
#include <algorithm>
#include <cmath>

#include "host/scene/joint_rows.h"
#include "host/verify/joint_frames.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

/* The length of the part of a vector along these axes. */
double length_along(uint32_t axes, const Eigen::Vector3d &v)
{
  return Eigen::Vector3d((axes & JOINT_X) != 0 ? v.x() : 0, (axes & JOINT_Y) != 0 ? v.y() : 0,
                         (axes & JOINT_Z) != 0 ? v.z() : 0)
      .norm();
}

/* Of a rotation between two frames: the whole of it, or how far it leans the axis x, about y, z or both. */
double angle_of(uint32_t rotations, const Eigen::Quaterniond &q)
{
  if (rotations == 0) return 0;
  if (rotations == JOINT_XYZ) return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
  const Eigen::Vector3d x = q * Eigen::Vector3d::UnitX();
  if (rotations == JOINT_Y) return std::atan2(std::abs(x.z()), std::hypot(x.x(), x.y()));
  if (rotations == JOINT_Z) return std::atan2(std::abs(x.y()), std::hypot(x.x(), x.z()));
  return 2 * std::atan2(std::hypot(q.y(), q.z()), std::hypot(q.x(), q.w()));
}

/* How far y of frame b is from the right angle to x of frame a that universal joints and wheels hold. */
double lean_across(const Eigen::Quaterniond &q)
{
  const Eigen::Vector3d y = q * Eigen::Vector3d::UnitY();
  return std::atan2(std::abs(y.x()), std::hypot(y.y(), y.z()));
}

} // namespace

std::vector<JointError> joint_errors(const Scene &scene, const PreciseBodies &states)
{
  std::vector<JointError> errors;
  for (const Joint &joint : scene.joints) {
    if (!joint.enabled) {
      errors.emplace_back();
      continue;
    }
    const HeldAxes held = held_by(joint);
    const JointFrame a = frame_of(joint.body_a, joint.position_a, joint.orientation_a, states),
                     b = frame_of(joint.body_b, joint.position_b, joint.orientation_b, states);
    const Eigen::Quaterniond back = a.axes.conjugate();
    const Eigen::Quaterniond turn = back * b.axes;
    errors.push_back({length_along(held.directions, back * (b.origin - a.origin)),
                      crosses(joint.type) ? lean_across(turn) : angle_of(held.rotations, turn)});
  }
  return errors;
}

JointErrorSummary summary_of(std::span<const JointError> errors)
{
  JointErrorSummary summary;
  for (const JointError &error : errors) {
    summary.max_distance = std::max(summary.max_distance, error.distance);
    summary.max_angle = std::max(summary.max_angle, error.angle);
    summary.mean_distance += error.distance / static_cast<double>(errors.size());
    summary.mean_angle += error.angle / static_cast<double>(errors.size());
  }
  return summary;
}

} // namespace tandem
