/* polygon_crossing.h - tests whether a polygon in space crosses itself. Such a polygon has no inside, and its
 * triangulation would be a surface that its author did not intend; mesh loaders refuse it.
 *
 * The test projects the polygon along the coordinate axis nearest to its normal, because dropping a coordinate rounds
 * nothing. Sides that only touch (a hole that a bridge joins to the outline) do not cross.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/geometry.h"

namespace tandem {

/* True if two sides cross. The last corner is joined to the first. */
TANDEM_API bool crosses_itself(std::span<const Vec3> corners);

} // namespace tandem
