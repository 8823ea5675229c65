/* document.h - the parts of a glTF file that physics needs, for the other readers in this folder.
 *
 * tinygltf's parser ignores values of wrong types and loads images that physics does not need. Its structures are
 * therefore filled here, through the same strict reader as Tandem's own format: nodes and scenes at once, meshes when a
 * collider refers to them (mesh.h). Parts that are only rendered are not read. This is not a public header.
 */
#pragma once

#include <array>
#include <map>

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

/* Where the keys of an animated node are: an animation, and a sampler of it, for each property that is animated. */
struct GltfKeys {
  static constexpr size_t count = 3;                    /* translation, rotation, scale */
  static size_t number_of(const std::string &property); /* `count` for any other */
  std::array<std::optional<std::pair<size_t, size_t>>, count> samplers;
};

struct GltfDocument {
  std::string where; /* the file */
  OutsideFiles outside;
  JsonDocument file;
  std::string binary; /* the second chunk of a .glb */
  std::vector<GltfNode> nodes;
  std::vector<int> roots;           /* of the scene that is simulated */
  std::map<int, GltfKeys> animated; /* by node */

  const GltfNode &node(int index) const { return nodes[size_t(index)]; }
  std::string label(int node) const; /* node 'Cup' */
  const std::string &place(int index) const { return node(index).place; }
  [[noreturn]] void refuse(int node, const std::string &what) const; /* InputError: file: node 'Cup': what */
  std::optional<JsonValue> physics_of(int node) const;
  JsonValue root() const { return {file.value(), where, "", JsonFloats::numbers}; }
  /* The document's extension, or an empty object if it has none. Error messages begin with `place`, that of the item
   * that refers to it. */
  JsonValue extension(const char *name, const std::string &place) const;
  bool uses(const std::string &extension) const;
};

/* Throws InputError if the file cannot be read, has an error, or requires an extension that might change the motion. */
GltfDocument read_gltf_document(const std::string &path, OutsideFiles outside);

/* The extension of that name of a node, a mesh, a buffer, …; nothing if there is none. */
std::optional<JsonValue> gltf_extension_of(const JsonValue &owner, const char *name);

/* Reads the index of an item of which the file has `count`. */
int gltf_index(const JsonValue &json, const char *what, size_t count);

} // namespace tandem
