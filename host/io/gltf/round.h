/* round.h - round shapes that are none of ours: a sphere, capsule or cylinder scaled unevenly, a capsule
 * that ends in a point. They become convex hulls of points on their surface, which are inside by less than a hundredth
 * of the radius. Not a public header. */
#pragma once

#include <tandem/scene.h>

namespace tandem {

/* Of the shape whose record this would be (see Shape in host/include/tandem/scene.h), scaled along its axes afterwards.
 * A capsule may have a radius of 0. */
Shape round_hull(ShapeType type, const Vec3 &size, const Vec3 &scale, const std::string &where);

} // namespace tandem
