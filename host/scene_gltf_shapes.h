/* scene_gltf_shapes.h - from the geometry of a collider to a shape: KHR_implicit_shapes, and meshes that are convex.
 *
 * A mesh becomes its convex hull where the file says so ("convexHull"), and where it is the same solid without: a closed surface
 * without dents. Not a public header.
 */
#pragma once

#include "host/scene_gltf_document.h"

#include <map>

namespace tandem {

struct GltfShape {
  uint32_t index = 0; /* in the scene */
  double offset = 0;  /* along Y, of the shape's frame in the collider's: a capsule that is a sphere really */
};

class GltfShapes {
public:
  /* New shapes are appended to `shapes`. */
  GltfShapes(const GltfDocument &document, std::vector<Shape> &shapes) : document_(document), shapes_(shapes) {}

  /* `scale`, along the axes of the collider, goes into the sizes; a mirroring one has its sign at X alone. */
  GltfShape read(const JsonValue &geometry, const std::array<double, 3> &scale);

private:
  GltfShape read_implicit(const JsonValue &geometry, const Vec3 &scale);
  uint32_t read_mesh(const JsonValue &geometry, const std::array<double, 3> &scale);
  uint32_t add(const Shape &shape);

  const GltfDocument &document_;
  std::vector<Shape> &shapes_;
  std::map<std::pair<uint32_t, Vec3>, uint32_t> implicit_;
  struct MeshUse {
    bool is_node, hull_asked;
    uint32_t index;
    std::array<double, 3> scale;
    auto operator<=>(const MeshUse &) const = default;
  };
  std::map<MeshUse, uint32_t> meshes_;
};

} // namespace tandem
