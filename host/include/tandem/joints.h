/* joints.h - what connects two bodies, or a body and the world.
 *
 * A joint has a frame on each side. It holds some directions and rotations of frame b in frame a, by type; docs/joints.md
 * shows each. The axis of a type that has one is x.
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <tandem/export.h>
#include <tandem/no_body.h>
#include <tandem/shapes.h>

namespace tandem {

enum class JointType : uint32_t { ball, fixed, hinge, slider, cylindrical, plane, parallel };

/* The name of each type, in the order of the enum: "ball", "fixed" and so on. */
TANDEM_API std::span<const char *const> joint_type_names();

struct Joint {
  std::string name;
  JointType type = JointType::ball;
  /* Indices into Scene::bodies, one of them of a dynamic body; no_body: the world, in which the frame of that side
   * stands. */
  uint32_t body_a = no_body, body_b = no_body;
  /* The frames: from the centre of mass, in the body's axes; of a side that is the world, in those of the world. */
  Point position_a{0, 0, 0}, position_b{0, 0, 0};
  Quat orientation_a{0, 0, 0, 1}, orientation_b{0, 0, 0, 1};
  bool collide = false; /* whether the two bodies collide */
};

} // namespace tandem
