/* joint_description.h - the limits and drives of one of the file's physicsJoints, as the extension describes them.
 *
 * A description says what two attachment frames may do with each other, in the axes of the first; where the frames are
 * is said by nodes (joints.h), and which joints of a scene do that is found by joint_parts.h. This is not a public
 * header.
 */
#pragma once

#include <limits>
#include <vector>

#include "host/io/json/reader.h"

namespace tandem {

/* A range of the distance of the frames along one axis, from a line or from each other; or of the angle about one axis,
 * of a cone, or of the whole turn. */
struct GltfLimit {
  static constexpr float none = std::numeric_limits<float>::infinity();
  JsonValue json;
  bool angular = false;
  std::vector<size_t> axes; /* one, two or three; 0 is X */
  float lower = -none, upper = none;
  float stiffness = 0, damping = 0; /* of soft limits; 0: a hard one */

  bool restricts() const { return lower > -none || upper < none; }
  bool is_hard() const { return stiffness == 0; }
};

struct GltfDrive {
  bool angular = false;
  size_t axis = 0;
  bool acceleration = false; /* stiffness and damping are for each kg, or kg m², that the drive moves */
  float max_force = GltfLimit::none;
  float position_target = 0, velocity_target = 0, stiffness = 0, damping = 0;
};

struct GltfJointDescription {
  std::vector<GltfLimit> limits;
  std::vector<GltfDrive> drives;
};

/* Throws InputError that names the limit or drive. */
GltfJointDescription read_gltf_joint_description(const JsonValue &json);

/* The same of frames that are mirrored along X, as those of mirrored nodes are (RigidPlace). */
GltfJointDescription mirrored(GltfJointDescription description);

} // namespace tandem
