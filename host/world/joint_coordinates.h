/* joint_coordinates.h - the coordinates of a joint in double, for what a program reads: the functions of
 * shared/joints/coordinates.h, which kernels use in floats. */
#pragma once

#include <array>
#include <cstdint>

namespace tandem {

/* Where the two frames of a joint are, in axes of the world. */
struct JointFrames {
  std::array<double, 3> gap; /* from frame a to frame b, m */
  std::array<double, 4> a, b;
};

/* m or rad; and its derivative by the velocities: direction . (velocity of b - of a, at frame b) + turn . (angular
 * velocity of b - of a). */
struct CoordinateOfFrames {
  double value;
  std::array<double, 3> direction, turn;
};

/* kind: JOINT_AXIS_ of shared/joints/joint_codes.h. */
CoordinateOfFrames coordinate_of(const JointFrames &frames, uint32_t kind);

} // namespace tandem
