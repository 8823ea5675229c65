/* closed_forms.h - built-in scenes whose exact motion is known: what errors are measured against.
 *
 * Part of the catalogue (catalog.h). closed_form_state() gives the exact motion where there is one; mass-ratio
 * and the rotation of free-flight have none and are measured against the reference backend.
 */
#pragma once

#include <optional>
#include <vector>

#include <tandem/world.h>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> closed_form_scenes();

/* Exact states of all bodies of a scene of this file after `time` seconds, none for others. Orientations and angular
 * velocities are exact for incline and bounce alone (they stay); for free-flight only centres of mass and their
 * velocities are. */
std::optional<std::vector<PreciseBodyState>> closed_form_state(const Scene &scene, double time);

} // namespace tandem
