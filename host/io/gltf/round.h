/* round.h - round shapes that Tandem does not have: a sphere, capsule or cylinder scaled unevenly, and a capsule that
 * ends in a point. They become convex hulls of points on their surface; the hulls lie inside it by less than a
 * hundredth of the radius. This is not a public header. */
#pragma once

#include <tandem/scene.h>

namespace tandem {

/* The hull of the shape that this record would describe (see Shape in host/include/tandem/shapes.h), scaled along its
 * axes afterwards. A capsule may have a radius of 0. */
Shape round_hull(ShapeType type, const Vec3 &size, const Vec3 &scale, const std::string &where);

} // namespace tandem
