/* shapes.h - from the geometry of a collider to a shape: KHR_implicit_shapes, and meshes.
 *
 * A mesh becomes its convex hull if the file says so ("convexHull") or if it is the same solid as its hull, a closed
 * convex surface. All others stay meshes. This is not a public header.
 */
#pragma once

#include "host/io/gltf/mesh.h"

namespace tandem {

struct GltfShape {
  Shape shape;
  double offset = 0; /* along Y, of the shape's frame in the collider's; not 0 for a capsule that is really a sphere */
};

class GltfShapes {
public:
  explicit GltfShapes(const GltfDocument &document) : document_(document), meshes_(document) {}

  /* `scale`, along the axes of the collider, is applied to the sizes; that of a mirrored collider is negative only at
   * X. The same geometry with the same scale gives the same shape, so that hulls and meshes are shared. */
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
