/* polygon_crossing.h - does a polygon in space cross itself? Such a one has no inside, and whatever cuts it into
 * triangles makes a surface of them that nobody meant.
 *
 * It is judged in its own plane, as seen along the axis nearest to the normal: dropping a coordinate rounds nothing.
 * Sides that only touch (a hole that a bridge joins to the outline) do not cross.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/geometry.h"

namespace tandem {

/* The corners in order; the last one is joined to the first. */
TANDEM_API bool crosses_itself(std::span<const Vec3> corners);

} // namespace tandem
