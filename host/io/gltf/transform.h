/* transform.h - transforms of glTF nodes, and their decomposition into a rigid pose and a scale.
 *
 *   node matrices  M = parent · T · R · S   -> position   = last column
 *                                           -> scale      = lengths of the columns  -> sizes of the shape
 *                                           -> orientation = columns / lengths      (shear is refused)
 *
 * This is not a public header.
 */
#pragma once

#include "host/io/gltf/document.h"

namespace tandem {

struct Transform {
  double column[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double translation[3] = {0, 0, 0};
};

Transform operator*(const Transform &a, const Transform &b);
Point transformed(const Transform &t, const Point &p);
bool is_mirrored(const Transform &t);

/* Throws InputError if the node's numbers are not a transform. */
Transform local_transform(const GltfDocument &document, int node);

/* The rigid pose and the scale of a transform. A mirroring transform is decomposed into a mirroring along X (the sign
 * of scale[0]) and then a rotation, because the implicit shapes are symmetric to that mirroring. */
struct RigidPlace {
  Point position{0, 0, 0};
  std::array<double, 4> orientation{0, 0, 0, 1}; /* x y z w */
  std::array<double, 3> scale{1, 1, 1};
};

bool is_scaled_to_nothing(const Transform &t);
/* Throws InputError for shear, and for a scale of zero; `what` is what stands there. */
RigidPlace rigid_place(const GltfDocument &document, int node, const Transform &world, const char *what = "collider");

} // namespace tandem
