/* document.h - a glTF file as far as physics reads it, for the readers of its parts beside it.
 *
 * tinygltf's parser passes over values of wrong types and loads pictures that physics never looks at, so its structures
 * are filled here, through the same strict reader as our own format: nodes and scenes at once, meshes when a collider
 * asks (mesh.h). Whatever only renders is not even looked at. Not a public header.
 */
#pragma once

#include <map>
#include <set>

#include "host/io/input_file.h"
#include "host/io/json/reader.h"

namespace tandem {

inline constexpr const char *shapes_extension = "KHR_implicit_shapes";
inline constexpr const char *bodies_extension = "KHR_physics_rigid_bodies";

struct GltfNode {
  std::string name, place; /* place: file: node 'Cup' */
  std::vector<int> children;
  std::vector<double> matrix, translation, rotation, scale, weights; /* empty where the file has none */
  std::optional<int> mesh;
  bool has_skin = false, has_instances = false;
  const nlohmann::json *physics = nullptr; /* the node's bodies_extension */
};

struct GltfDocument {
  std::string where; /* the file */
  OutsideFiles outside;
  JsonDocument file;
  std::string binary; /* the second chunk of a .glb */
  std::vector<GltfNode> nodes;
  std::vector<int> roots; /* of the scene that is simulated */
  std::set<int> animated;

  const GltfNode &node(int index) const { return nodes[size_t(index)]; }
  std::string label(int node) const; /* node 'Cup' */
  const std::string &place(int index) const { return node(index).place; }
  [[noreturn]] void refuse(int node, const std::string &what) const; /* InputError: file: node 'Cup': what */
  std::optional<JsonValue> physics_of(int node) const;
  JsonValue root() const { return {file.value(), where, "", JsonFloats::numbers}; }
  /* Of the document; an empty object where it has none. Complaints about it begin with `place`, that of what asks for
   * it. */
  JsonValue extension(const char *name, const std::string &place) const;
  bool uses(const std::string &extension) const;
};

/* InputError where the file cannot be read, has a mistake, or requires an extension that might change the motion. */
GltfDocument read_gltf_document(const std::string &path, OutsideFiles outside);

/* The extension of that name of a node, a mesh, a buffer, …; nothing where there is none. */
std::optional<JsonValue> gltf_extension_of(const JsonValue &owner, const char *name);

/* The index of something of which the file has `count`. */
int gltf_index(const JsonValue &json, const char *what, size_t count);

} // namespace tandem
