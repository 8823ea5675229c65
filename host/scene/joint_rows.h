/* joint_rows.h - shared/joints.def as a table: the name of each type of joint, and what it locks. */
#pragma once

#include <cstdint>
#include <span>

#include <tandem/joints.h>

namespace tandem {

struct JointRow {
  JointType choice;
  const char *name, *what;
  uint32_t directions, rotations; /* locked: bits JOINT_X, JOINT_Y, JOINT_Z of shared/joints/joint_codes.h */
};

std::span<const JointRow> joint_rows(); /* in the order of the enum */
const JointRow &row_of(JointType type);

} // namespace tandem
