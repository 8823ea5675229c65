/* scene.h - scenes from robots in URDF, the Unified Robot Description Format.
 *
 * Links become bodies, joints become joints; collision geometry, inertias, limits and dynamics are read. What is not
 * held is listed in Scene::notes, by name. docs/robots.md says what is what. This is not a public header.
 */
#pragma once

#include <tandem/scene.h>

#include "host/io/input_file.h"

namespace tandem {

/* Gravity is 9.81 m/s^2 along -Z, because URDF does not specify it and its robots stand along Z. Throws InputError, one
 * line: `file: line 12: <element name="...">: what`. */
Scene read_scene_urdf(const std::string &path, OutsideFiles outside = OutsideFiles::refused,
                      Coordinates coordinates = Coordinates::maximal);
Scene parse_scene_urdf(const std::string &text, const std::string &path, OutsideFiles outside = OutsideFiles::refused,
                       Coordinates coordinates = Coordinates::maximal);

} // namespace tandem
