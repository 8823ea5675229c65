/* coupling_error.cpp - how far couplings are from what they hold, from the poses of bodies, in double; see
 * tandem/metrics.h. */
#include <cmath>

#include "host/scene/coupling_rows.h"
#include "host/verify/joint_frames.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

/* Of a swing, four times the arc tangent of a part of its quaternion over 1 + w. */
double swing_angle(const Eigen::Quaterniond &q, uint32_t kind)
{
  const Eigen::Quaterniond p = q.w() < 0 ? Eigen::Quaterniond(-q.coeffs()) : q;
  const Eigen::Quaterniond twist = Eigen::Quaterniond(p.w(), p.x(), 0, 0).normalized(), swing = p * twist.conjugate();
  if (kind == JOINT_AXIS_CONE) return 2 * std::atan2(std::hypot(swing.y(), swing.z()), swing.w());
  return 4 * std::atan2(kind == JOINT_AXIS_SWING_Y ? swing.y() : swing.z(), 1 + swing.w());
}

double coordinate_of(const Joint &joint, uint32_t kind, const PreciseBodies &states)
{
  const JointFrame a = frame_of(joint.body_a, joint.position_a, joint.orientation_a, states),
                   b = frame_of(joint.body_b, joint.position_b, joint.orientation_b, states);
  const Eigen::Vector3d gap = a.axes.conjugate() * (b.origin - a.origin);
  if (kind <= JOINT_AXIS_Z) return gap[static_cast<int>(kind - JOINT_AXIS_X)];
  if (kind == JOINT_AXIS_DISTANCE) return gap.norm();
  const Eigen::Quaterniond q = a.axes.conjugate() * b.axes;
  if (kind != JOINT_AXIS_TWIST) return swing_angle(q, kind);
  return 2 * std::atan2(q.w() < 0 ? -q.x() : q.x(), std::abs(q.w()));
}

double error_of(const CouplingRow &row, double value)
{
  if (row.one_sided) return std::max(0.0, -value);
  return std::abs(row.period > 0 ? std::remainder(value, row.period) : value);
}

} // namespace

std::vector<double> coupling_errors(const Scene &scene, const PreciseBodies &states)
{
  std::vector<double> errors;
  for (const Coupling &coupling : scene.couplings) {
    const CouplingRow row = row_of(coupling, scene);
    errors.push_back(error_of(row, row.of_a * coordinate_of(scene.joints[coupling.joint_a], row.kind_a, states) +
                                       row.of_b * coordinate_of(scene.joints[coupling.joint_b], row.kind_b, states) -
                                       row.offset));
  }
  return errors;
}

} // namespace tandem
