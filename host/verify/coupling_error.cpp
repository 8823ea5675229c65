/* coupling_error.cpp - how far couplings are from what they hold, from the poses of bodies, in double; see
 * tandem/metrics.h. */
#include <cmath>

#include <tandem/round_to_float.h>

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

/* Whether the joint turns on beyond what is known of its angle. */
bool is_endless(const Joint &joint, uint32_t kind)
{
  const JointAxis &turn = joint.rotations[0];
  return kind == JOINT_AXIS_TWIST && !(double{turn.lower} >= -M_PI && double{turn.upper} <= M_PI);
}

/* Whole numbers m + ratio n are the multiples of 1/q if the ratio is p/q. If q is larger than that of a gear train that
 * someone would build as a mimic, the turns of the second angle are not regarded: they could make up for any error. */
double step_of_turns(double ratio)
{
  constexpr int most = 16;
  for (int q = 1; q <= most; ++q)
    if (round_to_float(std::round(ratio * q) / q) == round_to_float(ratio)) return 1.0 / q;
  return 1;
}

/* What whole turns of endless joints change the value by, which nothing tells apart; 0: nothing. */
double unknown_period(const CouplingRow &row, const Joint &joint_a, const Joint &joint_b)
{
  if (row.period > 0) return row.period;
  const double turn_a = 2 * M_PI * std::abs(row.of_a), turn_b = 2 * M_PI * std::abs(row.of_b);
  const bool a = is_endless(joint_a, row.kind_a), b = is_endless(joint_b, row.kind_b);
  if (a && b) return turn_a * step_of_turns(turn_b / turn_a);
  return a ? turn_a : b ? turn_b : 0;
}

double error_of(const CouplingRow &row, double period, double value)
{
  if (row.one_sided) return std::max(0.0, -value);
  return std::abs(period > 0 ? std::remainder(value, period) : value);
}

} // namespace

std::vector<double> coupling_errors(const Scene &scene, const PreciseBodies &states)
{
  std::vector<double> errors;
  for (const Coupling &coupling : scene.couplings) {
    const CouplingRow row = row_of(coupling, scene);
    const Joint &joint_a = scene.joints[coupling.joint_a], &joint_b = scene.joints[coupling.joint_b];
    const double value = row.of_a * coordinate_of(joint_a, row.kind_a, states) +
                         row.of_b * coordinate_of(joint_b, row.kind_b, states) - row.offset;
    errors.push_back(error_of(row, unknown_period(row, joint_a, joint_b), value));
  }
  return errors;
}

} // namespace tandem
