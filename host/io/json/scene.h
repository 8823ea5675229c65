/* scene.h - Tandem's own scene files: lossless JSON, described in docs/scene-format.md.
 *
 * Every float is written as a hexadecimal string, so that reading a written scene gives the same
 * bits; plain numbers are read as well, for files written by hand.
 */
#pragma once

#include <tandem/scene.h>

#include "host/io/input_file.h"

namespace tandem {

/* Reads and validates. Throws InputError with the file and the place in it (bodies[3].mass), or
 * line and column when it is not JSON at all. */
Scene read_scene_json(const std::string &path, OutsideFiles outside = OutsideFiles::refused);

/* The same from memory; `where` stands for the file name in messages. */
Scene parse_scene_json(const std::string &text, const std::string &where, OutsideFiles outside = OutsideFiles::refused);

/* The text of a scene file. Throws InputError when the scene is not valid. */
std::string to_scene_json(const Scene &scene);

/* Throws InputError when the file cannot be written. */
void write_scene_json(const Scene &scene, const std::string &path);

} // namespace tandem
