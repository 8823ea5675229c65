/* actuators.h - the check of all actuators of a scene. */
#pragma once

#include <span>
#include <string>

#include <tandem/scene.h>

namespace tandem {

/* From a lower to an upper control. One that is not limited on one side has an infinity there, and no other number may
 * be infinite. */
bool has_control_range(const Actuator &actuator);

/* number_at of a control of each. */
void numbers_at(std::span<const Actuator> actuators, const float *controls, float *numbers);

/* Throws InputError as validate() does, and for an actuator that sets what an earlier one sets. */
void check_actuators(const Scene &scene, const std::string &where);

} // namespace tandem
