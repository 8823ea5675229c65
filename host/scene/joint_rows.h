/* joint_rows.h - shared/joints.def as a table: the name of each type of joint, and what it locks. */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <tandem/actuators.h>
#include <tandem/joints.h>

namespace tandem {

struct JointRow {
  JointType choice;
  const char *name, *what;
  uint32_t directions, rotations; /* locked: bits JOINT_X, JOINT_Y, JOINT_Z of shared/joints/joint_codes.h */
};

TANDEM_API std::span<const JointRow> joint_rows(); /* in the order of the enum */
TANDEM_API const JointRow &row_of(JointType type);

/* A place of Scene::joints without a joint, as one that was destroyed leaves it. */
inline Joint vacant_joint()
{
  Joint vacant;
  vacant.enabled = false;
  return vacant;
}
inline bool is_vacant(const Joint &joint)
{
  return !joint.enabled && joint.body_a == no_body && joint.body_b == no_body;
}

/* What a joint holds: bits JOINT_X, JOINT_Y, JOINT_Z. */
struct HeldAxes {
  uint32_t directions, rotations;
  friend bool operator==(const HeldAxes &, const HeldAxes &) = default;
};
TANDEM_API HeldAxes held_by(const Joint &joint);

/* An axis of a joint that is limited, driven or braked; kind: JOINT_AXIS_ of joint_codes.h. */
struct UsedAxis {
  uint32_t kind;
  JointAxis axis;
};
TANDEM_API std::vector<UsedAxis> axes_used_by(const Joint &joint);
/* Whether it only keeps its bodies from colliding. */
TANDEM_API bool holds_nothing(const Joint &joint);
/* directions[axis], or rotations[axis - 3]. */
inline JointAxis &axis_of(Joint &joint, uint32_t axis)
{
  return axis < 3 ? joint.directions[axis] : joint.rotations[axis - 3];
}
inline const JointAxis &axis_of(const Joint &joint, uint32_t axis)
{
  return axis < 3 ? joint.directions[axis] : joint.rotations[axis - 3];
}
/* What a control sets of an axis. */
inline float &controlled_number(JointAxis &axis, Control sets)
{
  switch (sets) {
  case Control::force: return axis.force;
  case Control::target_position: return axis.target_position;
  default: return axis.target_velocity;
  }
}
/* The kind of directions[axis], or of rotations[axis - 3]; JOINT_AXIS_NONE: it is not free. */
uint32_t kind_of_axis(const Joint &joint, size_t axis);

/* Whether y of frame b stays at right angles to x of frame a, and the joint turns about both. */
inline bool crosses(JointType type) { return type == JointType::universal || type == JointType::wheel; }

/* The kinds of all axes that the joint leaves free, three directions and three rotations; JOINT_AXIS_NONE: none. */
std::array<uint32_t, 6> axis_kinds_of(const Joint &joint);

} // namespace tandem
