/* quickhull.h - the convex hull of points as triangles, decided in whole numbers.
 *
 * The quickhull algorithm (Barber, Dobkin, Huhdanpaa, 1996): each face keeps the points above it; the farthest of them
 * becomes a corner, the faces that it sees are replaced by a cone to it, and their points are shared out anew.
 *
 *          p                Which side of a face a point lies on is a determinant of coordinates that are multiples of
 *         / \               2^-41: it fits in 128 bits, so that no rounding decides anything. The surface is exactly
 *      __/___\__            convex at every moment, what p sees hangs together, its border is one cycle, and no
 *     /  hidden \           triangle is thin to nothing: there are no special cases, and the result is the same on
 *                           every machine.
 */
#pragma once

#include "host/geometry/vector.h"

namespace tandem {

using Polygon = std::vector<uint32_t>; /* counter-clockwise seen from outside */

/* What points are rounded to before their hull is found. Their coordinates must lie within -1/2 .. 1/2. */
constexpr double hull_grid = 0x1p-41;
Vector on_hull_grid(const Vector &point);

/* Triangles, some of which may lie in one plane; a point strictly inside or on a face is no corner unless it became one
 * on the way. Points that are at some moment above no face near them by more than `within` are passed over for good, so
 * that flat regions stay free of points that roundings put a little outside; with 0 the hull is exact. Empty where all
 * points lie in a plane. */
std::vector<Polygon> hull_triangles(const std::vector<Vector> &points, double within);

} // namespace tandem
