/* extensions.cpp - the lists of extensions; see extensions.h. They follow the registry of glTF extensions (Khronos). */
#include "host/io/gltf/extensions.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "host/io/gltf/document.h"

namespace tandem {
namespace {

constexpr std::string_view understood[] = {shapes_extension, bodies_extension, "KHR_mesh_quantization",
                                           "KHR_animation_pointer"};

/* Extensions that compress or instance vertices. */
constexpr std::string_view judged_by_use[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                              "KHR_meshopt_compression", "EXT_mesh_gpu_instancing"};

/* Families of extensions for materials, textures, light, sound and metadata. */
constexpr std::string_view families_without_meaning[] = {
    "KHR_materials_", "EXT_materials_", "ADOBE_materials_",      "KHR_texture_", "EXT_texture_",
    "MSFT_texture_",  "KHR_lights_",    "EXT_lights_",           "KHR_audio_",   "MSFT_audio_",
    "MSFT_packing_",  "KHR_xmp",        "KHR_gaussian_splatting"};
/* Extensions for visibility, levels of detail, outlines, techniques and metadata of parts of a mesh, and one that
 * asserts a property of its surface. */
constexpr std::string_view without_meaning[] = {
    "KHR_node_visibility",     "KHR_techniques_webgl",     "MSFT_lod",
    "MSFT_screencoverage",     "CESIUM_primitive_outline", "EXT_mesh_features",
    "EXT_structural_metadata", "EXT_instance_features",    "EXT_mesh_manifold",
    "KHR_node_selectability",  "KHR_node_hoverability",    "AGI_stk_metadata",
    "NV_materials_mdl"};

template <size_t n> bool lists(const std::string_view (&names)[n], const std::string &name)
{
  return std::find(names, names + n, name) != names + n;
}

bool may_be_passed_over(const std::string &name)
{
  const auto begins = [&](std::string_view family) { return name.starts_with(family); };
  return lists(understood, name) || lists(judged_by_use, name) || lists(without_meaning, name) ||
         std::any_of(std::begin(families_without_meaning), std::end(families_without_meaning), begins);
}

} // namespace

void check_required_extensions(const JsonValue &root)
{
  const std::optional<JsonValue> required = root.find("extensionsRequired"), used = root.find("extensionsUsed");
  for (size_t i = 0; used && i < used->array_size(); ++i) used->element(i).text(); /* refuses everything but names */
  for (size_t i = 0; required && i < required->array_size(); ++i)
    if (const std::string name = required->element(i).text(); !may_be_passed_over(name))
      required->element(i).fail(fmt::format("required extension {} is not supported yet, and might change the motion; "
                                            "take it from the list if it does not",
                                            name));
}

} // namespace tandem
