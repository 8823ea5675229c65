/* materials.cpp - reads friction, restitution and their combine rules; see materials.h. */
#include "host/io/gltf/materials.h"

namespace tandem {
namespace {

/* For two materials the extension's rule takes "average" before "minimum" and so on. A material that names no rule
 * yields to one that does, as the geometric mean does here. */
Combine read_combine(const JsonValue &material, const char *key)
{
  static constexpr const char *names[] = {"average", "minimum", "maximum", "multiply"};
  std::optional<JsonValue> rule = material.find(key);
  return rule ? Combine(rule->choice(names)) : Combine::geometric_mean;
}

Material read_material(const JsonValue &json)
{
  static constexpr const char *keys[] = {"staticFriction",  "dynamicFriction",    "restitution",
                                         "frictionCombine", "restitutionCombine", "name",
                                         "extras",          "extensions"};
  json.only_keys(keys);
  Material material;
  if (auto name = json.find("name")) material.name = name->text();
  if (auto friction = json.find("staticFriction")) material.static_friction = friction->number();
  if (auto friction = json.find("dynamicFriction")) material.dynamic_friction = friction->number();
  if (auto restitution = json.find("restitution")) material.restitution = restitution->number();
  material.friction_combine = read_combine(json, "frictionCombine");
  material.restitution_combine = read_combine(json, "restitutionCombine");
  return material;
}

} // namespace

std::vector<Material> read_gltf_materials(const JsonValue &bodies_extension)
{
  std::vector<Material> materials(1);
  materials[0].name = "default";
  materials[0].restitution_combine = Combine::geometric_mean;
  std::optional<JsonValue> list = bodies_extension.find("physicsMaterials");
  for (size_t i = 0; list && i < list->array_size(); ++i) materials.push_back(read_material(list->element(i)));
  return materials;
}

} // namespace tandem
