/* gltf_scenes.h - where the scenes lie that come with the glTF physics extensions: beside the source, never in it. */
#pragma once

#include <filesystem>
#include <string>

#include "tests/shared_data.h"

namespace tandem {

inline std::filesystem::path gltf_scenes() { return shared_data("gltf_physics/tests"); }

/* "Materials_01" -> the path of RigidBodies_Materials_01.gltf. */
inline std::string gltf_scene_path(const std::filesystem::path &folder, const std::string &name)
{
  return (folder / ("RigidBodies_" + name.substr(0, name.rfind('_'))) / ("RigidBodies_" + name + ".gltf")).string();
}

} // namespace tandem
