/* scene_gltf_mesh.h - the vertices and triangles of glTF meshes, from accessors and buffers. Not a public header. */
#pragma once

#include "host/geometry/geometry.h"
#include "host/scene_gltf_document.h"

namespace tandem {

struct GltfMesh {
  std::vector<Double3> vertices; /* of points and lines too: a hull has them */
  std::vector<Triangle> triangles;
};

/* `asks`, a geometry of a collider, begins the complaints. */
GltfMesh mesh_at(const GltfDocument &document, uint32_t mesh, const JsonValue &asks);

/* The meshes of the node and of all below it, in the node's own space: its own transform places the node, not the mesh. */
GltfMesh mesh_of_node(const GltfDocument &document, uint32_t node, const JsonValue &asks);

} // namespace tandem
