/* scene.h - Tandem's own scene files: lossless JSON, described in docs/scene-format.md.
 *
 * Every float is written as a hexadecimal string, so that reading a written scene gives the same bits; plain numbers
 * are read as well, for files written by hand.
 */
#pragma once

#include <tandem/load_scene.h> /* with the functions that read from memory and write */

namespace tandem {

/* Reads and validates a scene. Throws InputError with the file and the place in it (bodies[3].mass), or with line and
 * column if the file is not JSON. */
Scene read_scene_json(const std::string &path, OutsideFiles outside = OutsideFiles::refused);

} // namespace tandem
