/* scene.h - scenes from glTF 2.0 files with KHR_implicit_shapes and KHR_physics_rigid_bodies.
 *
 * What the pipeline knows is loaded: all shapes, convex hulls, meshes, several colliders a body; motions, materials,
 * collision filters. What it does not know is refused by name, with the node that asks for it; nothing is left out
 * silently. docs/scene-format.md lists both.
 */
#pragma once

#include <tandem/scene.h>

#include "host/io/input_file.h"

namespace tandem {

/* Reads .gltf (text) or .glb (binary; told from the content) and validates. Gravity is
 * 9.81 m/s² along -Y, as glTF knows none. Throws InputError: `file: node 'name': what`. */
Scene read_scene_gltf(const std::string &path, OutsideFiles outside = OutsideFiles::refused);

} // namespace tandem
