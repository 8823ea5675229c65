/* quickhull.h - the convex hull of points as triangles, computed in integers.
 *
 * It is the quickhull algorithm (Barber, Dobkin, Huhdanpaa, 1996): each face keeps the points above it; the farthest of
 * them becomes a corner, the faces visible from it are replaced by a cone to it, and their points are reassigned.
 *
 *          p                The side of a face on which a point lies is a determinant of coordinates that are multiples
 *         / \               of 2^-41. It fits in 128 bits, so no decision depends on rounding. The surface is exactly
 *      __/___\__            convex at every moment, the region visible from p is connected, its border is one cycle,
 *     /  hidden \           and no triangle is degenerate. There are no special cases, and the result is the same on
 *                           every machine.
 */
#pragma once

#include "host/geometry/vector.h"

namespace tandem {

using Polygon = std::vector<uint32_t>; /* counter-clockwise seen from outside */

/* Points are rounded to multiples of hull_grid before their hull is found. Their coordinates must lie within -1/2 ..
 * 1/2. */
constexpr double hull_grid = 0x1p-41;
Vector on_hull_grid(const Vector &point);

/* Triangles, some of which may be coplanar. A point strictly inside or on a face is no corner, unless it became one
 * during construction. A point that at some moment is at most `within` above the faces near it is discarded, so that
 * flat regions stay free of points that rounding put slightly outside; with 0 the hull is exact. The result is empty if
 * all points lie in a plane. */
std::vector<Polygon> hull_triangles(const std::vector<Vector> &points, double within);

} // namespace tandem
