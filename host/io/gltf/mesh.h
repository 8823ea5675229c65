/* mesh.h - the vertices and triangles of glTF meshes, from accessors and buffers. This is not a public header. */
#pragma once

#include "host/geometry/geometry.h"
#include "host/io/gltf/buffers.h"
#include "host/io/gltf/transform.h"

namespace tandem {

struct GltfMesh {
  std::vector<Double3> vertices; /* including those of points and lines, which a hull uses */
  std::vector<Triangle> triangles;
};

class GltfMeshes {
public:
  explicit GltfMeshes(const GltfDocument &document) : document_(document), buffers_(document) {}

  /* Error messages begin with `asks`, a geometry of a collider. */
  GltfMesh of_mesh(uint32_t mesh, const JsonValue &asks);
  /* The meshes of the node and of all nodes below it, in the node's own space: the transform of the node itself is not
   * applied. */
  GltfMesh of_node(uint32_t node, const JsonValue &asks);

private:
  void check_packing(const JsonValue &primitive, uint32_t accessor, const JsonValue &asks) const;
  void append_primitive(const JsonValue &primitive, const Transform &place, const JsonValue &asks, GltfMesh &mesh);
  void append_mesh(int index, const Transform &place, const JsonValue &asks, GltfMesh &mesh);

  const GltfDocument &document_;
  GltfBuffers buffers_;
};

} // namespace tandem
