/* transform.h - transforms of glTF nodes, and what a rigid body can take of them.
 *
 *   node matrices  M = parent · T · R · S   -> position   = last column
 *                                           -> scale      = lengths of the columns  -> sizes of the shape
 *                                           -> orientation = columns / lengths      (shear is refused)
 *
 * Not a public header.
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

/* InputError where the node's numbers are no transform. */
Transform local_transform(const GltfDocument &document, int node);

/* What is left of a transform when its scale went into the shape. A mirroring scale is a mirroring along X, of which
 * `scale` keeps the sign, before a rotation: the implicit shapes are symmetric to it. */
struct RigidPlace {
  Point position{0, 0, 0};
  std::array<double, 4> orientation{0, 0, 0, 1}; /* x y z w */
  std::array<double, 3> scale{1, 1, 1};
};

bool is_scaled_to_nothing(const Transform &t);
/* InputError for shear, and for a scale of zero. */
RigidPlace rigid_place(const GltfDocument &document, int node, const Transform &world);

} // namespace tandem
