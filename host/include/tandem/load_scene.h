/* load_scene.h - loads scenes from files and from the catalogue of built-in scenes. It belongs to the library
 * Tandem::io. Several threads may load scenes at once.
 *
 *   Scene scene = load_scene("box-grid:nx=8,ny=8,nz=8");
 *   Scene other = load_scene("crane.gltf");
 */
#pragma once

#include <string>

#include <tandem/export.h>
#include <tandem/scene.h>

namespace tandem {

/* Whether a scene may name files (a buffer of a glTF file, an OBJ file) outside its own folder. A scene may come from
 * an untrusted source, so by default they must lie in that folder or below it after links and `..` are resolved. */
enum class OutsideFiles { refused, allowed };

/* How the joints of a scene hold bodies that make a tree: as constraints between them, or as the coordinates of an
 * articulation (make_articulations). A robot is read link by link then, with a coordinate for each of its joints. */
enum class Coordinates { maximal, reduced };

/* A path that ends in .json (docs/scene-format.md), .gltf or .glb (KHR_implicit_shapes and KHR_physics_rigid_bodies) is
 * a file, and so is one in .urdf, or in .xml or .mjcf (docs/robots.md); any other text is a built-in scene: `name` or
 * `name:key=value,key=value`. Throws InputError, one line with the place, if the scene does not exist, cannot be read,
 * is damaged, or asks for something unsupported that would change the motion. */
TANDEM_API Scene load_scene(const std::string &spec_or_path, OutsideFiles outside = OutsideFiles::refused,
                            Coordinates coordinates = Coordinates::maximal);

/* Reads a scene file from memory; `where` stands for the file name in messages. Throws InputError as load_scene
 * does. */
TANDEM_API Scene parse_scene_json(const std::string &text, const std::string &where,
                                  OutsideFiles outside = OutsideFiles::refused);

/* The text of a scene file, which can be read back without loss. Throws InputError if the scene is not valid. */
TANDEM_API std::string to_scene_json(const Scene &scene);

/* Throws InputError if the file cannot be written. */
TANDEM_API void write_scene_json(const Scene &scene, const std::string &path);

} // namespace tandem
