/* joint_coordinates.cpp - see joint_coordinates.h. */
#include "host/pipeline/solvers/in_double.h"

namespace tandem::in_double {
#include "shared/joints/coordinates.h"
} // namespace tandem::in_double

#include "host/world/joint_coordinates.h"

namespace tandem {

CoordinateOfFrames coordinate_of(const JointFrames &frames, uint32_t kind)
{
  const auto &[gap, a, b] = frames;
  in_double::joint j{};
  j.gap = in_double::make_vec3(gap[0], gap[1], gap[2]);
  const in_double::joint_frames f{in_double::rotation_of(in_double::make_quat(a[0], a[1], a[2], a[3])),
                                  in_double::quat_multiply(in_double::make_quat(-a[0], -a[1], -a[2], a[3]),
                                                           in_double::make_quat(b[0], b[1], b[2], b[3]))};
  const in_double::joint_coordinate c = in_double::coordinate_of(j, f, kind);
  return {c.value, {c.direction.x, c.direction.y, c.direction.z}, {c.turn.x, c.turn.y, c.turn.z}};
}

} // namespace tandem
