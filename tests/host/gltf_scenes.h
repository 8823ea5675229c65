/* gltf_scenes.h - where the scenes lie that come with the glTF physics extensions: beside the source, never in it. */
#pragma once

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

namespace tandem {

/* TANDEM_SHARED_DATA or ../shared/data; empty, and said, where it is not there. */
inline std::filesystem::path gltf_scenes()
{
  const char *given = std::getenv("TANDEM_SHARED_DATA");
  const std::filesystem::path folder = std::filesystem::path(given ? given : TANDEM_SOURCE_DIR "/../shared/data") / "gltf_physics/tests";
  if (std::filesystem::is_directory(folder)) return folder;
  std::cout << "skipped: no glTF physics scenes in " << folder << "\n";
  return {};
}

/* "Materials_01" -> the path of RigidBodies_Materials_01.gltf. */
inline std::string gltf_scene_path(const std::filesystem::path &folder, const std::string &name)
{
  return (folder / ("RigidBodies_" + name.substr(0, name.rfind('_'))) / ("RigidBodies_" + name + ".gltf")).string();
}

} // namespace tandem
