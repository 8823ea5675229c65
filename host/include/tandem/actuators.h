/* actuators.h - what drives an axis of a joint by a control, in units of its own.
 *
 * An actuator stands between a program and a number of an axis, its force or one of its targets, so that a program
 * drives a robot by its controls without knowing its gears and ranges. World::set_controls and Worlds::choose_controls
 * take the controls of actuators; docs/robots.md shows a robot of MJCF that is driven so.
 */
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include <tandem/export.h>

namespace tandem {

/* What a program may set of an axis of a joint in every step: JointAxis::force, target_position or target_velocity. */
enum class Control : uint32_t { force, target_position, target_velocity };

/* The name of each, in the order of the enum: "force" and so on. */
TANDEM_API std::span<const char *const> control_names();

/* The number of the axis is offset + factor * control, where a control beyond lower or upper counts as that limit. No
 * two actuators set the same number of one axis. */
struct Actuator {
  static constexpr float unlimited = std::numeric_limits<float>::infinity();

  std::string name;
  uint32_t joint = 0; /* index into Scene::joints */
  uint32_t axis = 3;  /* 0 to 2: directions x, y, z; 3 to 5: rotations */
  Control sets = Control::force;
  float offset = 0, factor = 1;                /* finite; N or N m, m or rad, m/s or rad/s */
  float lower = -unlimited, upper = unlimited; /* of the control */

  friend bool operator==(const Actuator &, const Actuator &) = default;
};

/* The number of the axis at a control. lower must be at most upper. A control that is not finite is returned as it is,
 * for the caller to refuse. */
TANDEM_API float number_at(const Actuator &actuator, float control);

} // namespace tandem
