/* mesh.h - the vertices and triangles of glTF meshes, from accessors and buffers. Not a public header. */
#pragma once

#include "host/geometry/geometry.h"
#include "host/io/gltf/buffers.h"
#include "host/io/gltf/transform.h"

namespace tandem {

struct GltfMesh {
  std::vector<Double3> vertices; /* of points and lines too: a hull has them */
  std::vector<Triangle> triangles;
};

class GltfMeshes {
public:
  explicit GltfMeshes(const GltfDocument &document) : document_(document), buffers_(document) {}

  /* `asks`, a geometry of a collider, begins the complaints. */
  GltfMesh of_mesh(uint32_t mesh, const JsonValue &asks);
  /* The meshes of the node and of all below it, in the node's own space: its own transform places the node, not the
   * mesh. */
  GltfMesh of_node(uint32_t node, const JsonValue &asks);

private:
  void check_packing(const JsonValue &primitive, uint32_t accessor, const JsonValue &asks) const;
  void append_primitive(const JsonValue &primitive, const Transform &place, const JsonValue &asks, GltfMesh &mesh);
  void append_mesh(int index, const Transform &place, const JsonValue &asks, GltfMesh &mesh);

  const GltfDocument &document_;
  GltfBuffers buffers_;
};

} // namespace tandem
