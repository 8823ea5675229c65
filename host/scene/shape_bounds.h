/* shape_bounds.h - how far a shape reaches in its body; broadphase, midphase and contact distances start from it. */
#pragma once

#include <tandem/scene.h>

namespace tandem {

/* A box along the axes of a frame that holds a shape, rounded outward. */
struct ShapeBox {
  Vec3 center{0, 0, 0}, half_extents{0, 0, 0};
};
/* position, orientation: of the shape in the frame. Not for half-spaces. */
ShapeBox box_around(const Shape &shape, const Vec3 &position, const Quat &orientation);
ShapeBox box_around(const Scene &scene, const Body &body); /* in the body's frame */

/* Radius of the sphere about the body's centre that holds the shape; 0 for a half-space. */
float bounding_radius(const Scene &scene, const Body &body);

/* What kernels read as the size of a shape (body_shape): that of scene.h; of a hull or mesh half extents of a box about
 * its origin; of a compound three times the least half extent of its children, since only the least is asked for. */
Vec3 kernel_size(const Shape &shape);

} // namespace tandem
