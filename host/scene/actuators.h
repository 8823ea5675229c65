/* actuators.h - the check of all actuators of a scene. */
#pragma once

#include <string>

#include <tandem/scene.h>

namespace tandem {

/* Throws InputError as validate() does, and for an actuator that sets what an earlier one sets. */
void check_actuators(const Scene &scene, const std::string &where);

} // namespace tandem
