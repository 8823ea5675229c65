/* joint_rows.h - shared/joints.def as a table: the name of each type of joint, and what it locks. */
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tandem/joints.h>

namespace tandem {

struct JointRow {
  JointType choice;
  const char *name, *what;
  uint32_t directions, rotations; /* locked: bits JOINT_X, JOINT_Y, JOINT_Z of shared/joints/joint_codes.h */
};

TANDEM_API std::span<const JointRow> joint_rows(); /* in the order of the enum */
TANDEM_API const JointRow &row_of(JointType type);

/* What a joint holds: bits JOINT_X, JOINT_Y, JOINT_Z. */
struct HeldAxes {
  uint32_t directions, rotations;
};
TANDEM_API HeldAxes held_by(const Joint &joint);

/* An axis of a joint that is limited, driven or braked; kind: JOINT_AXIS_ of joint_codes.h. */
struct UsedAxis {
  uint32_t kind;
  JointAxis axis;
};
TANDEM_API std::vector<UsedAxis> axes_used_by(const Joint &joint);
/* The kind of directions[axis], or of rotations[axis - 3]; JOINT_AXIS_NONE: it is not free. */
uint32_t kind_of_axis(const Joint &joint, size_t axis);

} // namespace tandem
