/* actuators.cpp - from controls to numbers of axes, and the validation of actuators; see <tandem/actuators.h>. */
#include "host/scene/actuators.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <tandem/actuators.h>

#include "host/scene/checker.h"
#include "host/scene/joint_rows.h"
#include "shared/joints/joint_codes.h"

namespace tandem {

std::span<const char *const> control_names()
{
  static constexpr const char *names[] = {"force", "target_position", "target_velocity"};
  return names;
}

/* It is no inline function, because another compilation might round the sum and the product once, not twice. */
float number_at(const Actuator &actuator, float control)
{
  if (!std::isfinite(control)) return control;
  const float product = actuator.factor * std::clamp(control, actuator.lower, actuator.upper);
  return actuator.offset + product;
}

void numbers_at(std::span<const Actuator> actuators, const float *controls, float *numbers)
{
  for (size_t k = 0; k < actuators.size(); ++k) numbers[k] = number_at(actuators[k], controls[k]);
}

bool has_control_range(const Actuator &actuator)
{
  return actuator.lower <= actuator.upper && actuator.lower < Actuator::unlimited &&
         actuator.upper > -Actuator::unlimited;
}

namespace {

void check_driven_axis(const Actuator &actuator, const Scene &scene, const Checker &check)
{
  if (actuator.joint >= scene.joints.size())
    check.fail(fmt::format("joint {} does not exist; the scene has {} joints", actuator.joint, scene.joints.size()));
  const Joint &joint = scene.joints[actuator.joint];
  if (is_vacant(joint)) check.fail(fmt::format("joint {} was destroyed; it has no bodies", actuator.joint));
  if (actuator.axis >= 6)
    check.fail(fmt::format("axis {} does not exist; 0 to 2 are directions, 3 to 5 rotations", actuator.axis));
  if (kind_of_axis(joint, actuator.axis) == JOINT_AXIS_NONE)
    check.fail(fmt::format("axis {} is not free in joint {}, which is of type {}", actuator.axis, actuator.joint,
                           row_of(joint.type).name));
}

} // namespace

void validate(const Scene &scene, const Actuator &actuator, size_t index, const std::string &where)
{
  const Checker check{where, "actuator", index, actuator.name};
  if (static_cast<size_t>(actuator.sets) >= control_names().size())
    check.fail("sets an unknown number; force, target_position and target_velocity exist");
  check_driven_axis(actuator, scene, check);
  check.finite("offset", actuator.offset);
  check.finite("factor", actuator.factor);
  if (!has_control_range(actuator))
    check.fail(fmt::format("controls are from {} to {}; lower must be at most upper, and without one there is no limit",
                           actuator.lower, actuator.upper));
}

void check_actuators(const Scene &scene, const std::string &where)
{
  std::map<std::tuple<uint32_t, uint32_t, Control>, size_t> setter_of;
  for (size_t index = 0; index < scene.actuators.size(); ++index) {
    const Actuator &actuator = scene.actuators[index];
    validate(scene, actuator, index, where);
    const auto [first, is_new] = setter_of.emplace(std::tuple(actuator.joint, actuator.axis, actuator.sets), index);
    if (is_new) continue;
    refuse(where, label("actuator", index, actuator.name),
           fmt::format("sets the {} of axis {} of joint {}, which {} sets already; let each set a number of its own",
                       control_names()[static_cast<size_t>(actuator.sets)], actuator.axis, actuator.joint,
                       label("actuator", first->second, scene.actuators[first->second].name)));
  }
}

} // namespace tandem
