/* shape_bounds.h - the extent of a shape in its body, from which broadphase, midphase and contact distances are
 * computed. */
#pragma once

#include <tandem/scene.h>

namespace tandem {

/* An axis-aligned box in some frame that contains a shape, rounded outward. */
struct ShapeBox {
  Vec3 center{0, 0, 0}, half_extents{0, 0, 0};
};
/* position, orientation: the pose of the shape in that frame. Half-spaces are not allowed. */
ShapeBox box_around(const Shape &shape, const Vec3 &position, const Quat &orientation);
ShapeBox box_around(const Scene &scene, const Body &body); /* in the body's frame */

/* Radius of the sphere about the body's centre that contains the shape; 0 for a half-space. */
float bounding_radius(const Scene &scene, const Body &body);

/* The size of a shape that kernels read (body_shape): that of shapes.h; of a hull or mesh the half extents of a box
 * about its origin; of a compound three times the least half extent of its children, because kernels use only the
 * least. */
Vec3 kernel_size(const Shape &shape);

} // namespace tandem
