/* shape_bounds.h - how far a shape reaches in its body: what broadphase and contact distances start from. */
#pragma once

#include "host/scene.h"

namespace tandem {

/* A box along the body's axes that holds the shape, rounded outward. */
struct ShapeBox {
  Vec3 center{0, 0, 0}, half_extents{0, 0, 0};
};
ShapeBox box_around(const Scene &scene, const Body &body); /* not for half-spaces */

/* Radius of the sphere about the body's centre that holds the shape; 0 for a half-space. */
float bounding_radius(const Scene &scene, const Body &body);

/* What kernels read as the size of a shape (body_shape): that of scene.h; of a hull half extents of a box about its origin. */
Vec3 kernel_size(const Shape &shape);

} // namespace tandem
