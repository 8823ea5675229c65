/* load_scene.h - scenes from files and from the catalogue of built-in scenes; of the library Tandem::io.
 *
 *   Scene scene = load_scene("box-grid:nx=8,ny=8,nz=8");
 *   Scene other = load_scene("crane.gltf");
 */
#pragma once

#include <string>

#include <tandem/export.h>
#include <tandem/scene.h>

namespace tandem {

/* A scene may come from anywhere, so what it names (a buffer of a glTF file, an OBJ file) lies in its own folder or
 * below it, wherever links and `..` lead; who trusts a scene says so. */
enum class OutsideFiles { refused, allowed };

/* A path that ends in .json (docs/scene-format.md), .gltf or .glb (KHR_implicit_shapes and KHR_physics_rigid_bodies) is
 * a file, all else a built-in scene: `name` or `name:key=value,key=value`. InputError, one line with the place, for
 * what cannot be read, is damaged, asks for what would change the motion and is not there, or does not exist. */
TANDEM_API Scene load_scene(const std::string &spec_or_path, OutsideFiles outside = OutsideFiles::refused);

/* A scene file from memory; `where` stands for the file name in messages. InputError as above. */
TANDEM_API Scene parse_scene_json(const std::string &text, const std::string &where,
                                  OutsideFiles outside = OutsideFiles::refused);

/* The text of a scene file, which is read back without loss. InputError when the scene is not valid. */
TANDEM_API std::string to_scene_json(const Scene &scene);

/* InputError when the file cannot be written. */
TANDEM_API void write_scene_json(const Scene &scene, const std::string &path);

} // namespace tandem
