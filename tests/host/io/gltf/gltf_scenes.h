/* gltf_scenes.h - finds the scenes that come with the glTF physics extensions, which are never part of the source. */
#pragma once

#include <filesystem>
#include <string>

#include "tests/shared_data.h"

namespace tandem {

inline std::filesystem::path gltf_scenes() { return shared_data("gltf_physics/tests"); }

/* Turns "Materials_01" into the path of RigidBodies_Materials_01.gltf. */
inline std::string gltf_scene_path(const std::filesystem::path &folder, const std::string &name)
{
  return (folder / ("RigidBodies_" + name.substr(0, name.rfind('_'))) / ("RigidBodies_" + name + ".gltf")).string();
}

} // namespace tandem
