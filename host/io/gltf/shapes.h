/* shapes.h - from the geometry of a collider to a shape: KHR_implicit_shapes, and meshes.
 *
 * A mesh becomes its convex hull where the file says so ("convexHull"), and where it is the same solid without: a
 * closed surface without dents. All others stay meshes. Not a public header.
 */
#pragma once

#include "host/io/gltf/mesh.h"

namespace tandem {

struct GltfShape {
  Shape shape;
  double offset = 0; /* along Y, of the shape's frame in the collider's: a capsule that is a sphere really */
};

class GltfShapes {
public:
  explicit GltfShapes(const GltfDocument &document) : document_(document), meshes_(document) {}

  /* `scale`, along the axes of the collider, goes into the sizes; a mirroring one has its sign at X alone. The same
   * geometry in the same scale gives the same shape: hull and mesh are shared. */
  GltfShape read(const JsonValue &geometry, const std::array<double, 3> &scale);

private:
  GltfShape read_implicit(const JsonValue &geometry, uint32_t index, const Vec3 &scale) const;

  const GltfDocument &document_;
  GltfMeshes meshes_;
  struct Use {
    int source; /* shape, node or mesh */
    bool hull_asked;
    uint32_t index;
    std::array<double, 3> scale;
    auto operator<=>(const Use &) const = default;
  };
  std::map<Use, GltfShape> known_;
};

} // namespace tandem
