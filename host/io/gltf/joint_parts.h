/* joint_parts.h - which joints do what one of the file's physicsJoints describes.
 *
 * Directions and rotations that are held decide the type of the first joint: all of both are a weld, all directions
 * a ball, and so on (shared/joints.def). Ranges, springs and drives become axes of it. A range or a drive about one
 * axis is of the twist about it, which the extension's own metric is too; the twist of a joint is about its x, so the
 * axes are turned in a circle where another is meant, and a second such rotation needs a joint of its own:
 *
 *   limits X Y Z = 0, about Y = Z = 0     hinge
 *   limits X Y Z = 0, about X -1..1       ball, its rotations[0] from -1 to 1
 *                     about Y -1..1       six_dof that holds nothing, its x along Y, its rotations[0] from -1 to 1
 *   limit  X Y Z 0..2                     distance, up to 2
 *
 * This is not a public header.
 */
#pragma once

#include "host/geometry/geometry.h"
#include "host/io/gltf/joint_description.h"

namespace tandem {

struct GltfJointPart {
  Joint joint;                          /* what it holds, limits and drives; its frames are still to be placed */
  Axes held_directions, held_rotations; /* whatever its type */
  size_t x = 0;                         /* the axis of the attachment frames along its own x: 0 is X; y and z follow */
  Double3 shift{0, 0, 0};               /* of its frame a from the first attachment frame, in axes of that */
  std::array<bool, 6> acceleration{};   /* of directions and rotations: drives that the moved mass is still to scale */

  /* The turn from the axes of the attachment frames to its own. */
  Rotation turn() const;
};

/* At least one. Throws InputError that names a limit which no joint keeps, or which another contradicts. */
std::vector<GltfJointPart> joint_parts_of(const GltfJointDescription &description);

} // namespace tandem
