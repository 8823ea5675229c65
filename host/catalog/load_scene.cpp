/* load_scene.cpp - a scene by its name in the catalogue or by the path of its file, whichever it is. */
#include <algorithm>
#include <string>

#include <tandem/articulations.h>
#include <tandem/load_scene.h>

#include "host/catalog/catalog.h"
#include "host/io/gltf/scene.h"
#include "host/io/json/scene.h"
#include "host/io/mjcf/scene.h"
#include "host/io/urdf/scene.h"

namespace tandem {
namespace {

std::string lower_extension(const std::string &path)
{
  size_t dot = path.rfind('.');
  if (dot == std::string::npos) return "";
  std::string extension = path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return extension;
}

/* Robots know of armatures, and of joints that are several. */
Scene load_in_maximal_coordinates(const std::string &spec_or_path, const std::string &extension, OutsideFiles outside)
{
  if (extension == ".json") return read_scene_json(spec_or_path, outside);
  if (extension == ".gltf" || extension == ".glb") return read_scene_gltf(spec_or_path, outside);
  return build_scene(parse_scene_spec(spec_or_path));
}

} // namespace

Scene load_scene(const std::string &spec_or_path, OutsideFiles outside, Coordinates coordinates)
{
  const std::string extension = lower_extension(spec_or_path);
  if (extension == ".urdf") return read_scene_urdf(spec_or_path, outside, coordinates);
  if (extension == ".xml" || extension == ".mjcf") return read_scene_mjcf(spec_or_path, outside, coordinates);
  Scene scene = load_in_maximal_coordinates(spec_or_path, extension, outside);
  if (coordinates == Coordinates::reduced) make_articulations(scene, spec_or_path);
  return scene;
}

} // namespace tandem
