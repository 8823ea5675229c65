/* scene.h - scenes from glTF 2.0 files with KHR_implicit_shapes and KHR_physics_rigid_bodies.
 *
 * The reader loads what the pipeline supports: all shapes, convex hulls, meshes, several colliders a body; motions,
 * materials, collision filters, joints. What is not supported is refused by name, together with the node that uses it;
 * nothing is omitted silently. docs/scene-format.md lists both.
 */
#pragma once

#include <tandem/scene.h>

#include "host/io/input_file.h"

namespace tandem {

/* Reads .gltf (text) or .glb (binary; recognised by its content) and validates the scene. Gravity is 9.81 m/s² along
 * -Y, because glTF does not specify it. Throws InputError: `file: node 'name': what`. */
Scene read_scene_gltf(const std::string &path, OutsideFiles outside = OutsideFiles::refused);

} // namespace tandem
