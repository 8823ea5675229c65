/* scene.h - scenes from models in MJCF, MuJoCo's XML.
 *
 * Bodies, geoms, joints, default classes, actuators of joints, equalities of bodies and excluded contacts are read;
 * what is not held is listed in Scene::notes, by name. docs/robots.md says what becomes what. This is not a public
 * header.
 */
#pragma once

#include <tandem/scene.h>

#include "host/io/input_file.h"

namespace tandem {

/* Throws InputError, one line: `file: line 12: <element name="...">: what`. */
Scene read_scene_mjcf(const std::string &path, OutsideFiles outside = OutsideFiles::refused,
                      Coordinates coordinates = Coordinates::maximal);
Scene parse_scene_mjcf(const std::string &text, const std::string &path, OutsideFiles outside = OutsideFiles::refused,
                       Coordinates coordinates = Coordinates::maximal);

} // namespace tandem
