/* closed_forms.h - built-in scenes with known exact motion, to which errors are compared.
 *
 * They are part of the catalogue (catalog.h). closed_form_state() gives the exact motion where there is one; mass-ratio
 * and the rotation of free-flight have none and are compared with the reference backend.
 */
#pragma once

#include <optional>
#include <vector>

#include <tandem/world.h>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> closed_form_scenes();

/* The exact states of all bodies of a scene of this file after `time` seconds; nothing for other scenes. Orientations
 * and angular velocities are exact only for incline and bounce, where they are constant; for free-flight only centres
 * of mass and their velocities are exact. */
std::optional<std::vector<PreciseBodyState>> closed_form_state(const Scene &scene, double time);

} // namespace tandem
