/* joint_frames.h - the frames of a joint in the world, from the poses of its bodies, in double. */
#pragma once

#include <array>

#include <Eigen/Geometry>

#include <tandem/metrics.h>

namespace tandem {

struct JointFrame {
  Eigen::Vector3d origin;
  Eigen::Quaterniond axes;
};

template <class Real> Eigen::Quaterniond turn_of(const std::array<Real, 4> &q)
{
  return Eigen::Quaterniond(double{q[3]}, double{q[0]}, double{q[1]}, double{q[2]}).normalized();
}

inline JointFrame frame_of(uint32_t body, const Point &position, const Quat &orientation, const PreciseBodies &states)
{
  const Eigen::Vector3d local(position.data());
  if (body == no_body) return {local, turn_of(orientation)};
  const Eigen::Quaterniond turn = turn_of(states[body].orientation);
  return {Eigen::Vector3d(states[body].position.data()) + turn * local, turn * turn_of(orientation)};
}

} // namespace tandem
