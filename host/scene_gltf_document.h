/* scene_gltf_document.h - a parsed glTF file with its two physics extensions, for the readers of its parts (scene_gltf_*.cpp).
 *
 * tinygltf parses the file; the JSON of the extensions goes through the same strict reader as our own format. Not a public header.
 */
#pragma once

#include "host/json_reader.h"

#include <nlohmann/json.hpp>
#include <string>
#include <tiny_gltf.h>

namespace tandem {

inline constexpr const char *shapes_extension = "KHR_implicit_shapes";
inline constexpr const char *bodies_extension = "KHR_physics_rigid_bodies";

struct GltfDocument {
  tinygltf::Model model;
  std::string where;             /* the file */
  nlohmann::json shapes, bodies; /* the document's two extensions; empty objects where it has none */

  const tinygltf::Node &node(int index) const { return model.nodes[size_t(index)]; }
  std::string label(int node) const;                                /* node 'Cup' */
  std::string place(int node) const { return where + ": " + label(node); }
  [[noreturn]] void refuse(int node, const std::string &what) const; /* InputError: file: node 'Cup': what */
  void require_node(int node) const;                                 /* InputError where it does not exist */
  nlohmann::json extensions_of(int node) const;                      /* an object */
};

/* InputError where the file cannot be read, or requires another extension. */
GltfDocument read_gltf_document(const std::string &path);

} // namespace tandem
