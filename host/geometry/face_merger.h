/* face_merger.h - joins neighbouring faces of a closed convex surface that lie in one plane within a tolerance.
 *
 *      a---b---c        Over each edge, flattest first, the two faces become one if the polygon
 *      |  /|  /|        - has all corners within the tolerance of one plane (not of the neighbour's: nothing drifts
 *      | / | / |          around a curve),
 *      |/  |/  |        - stays convex: no corner lies deeper than the tolerance behind its neighbours,
 *      d---e---f        - still goes round once.
 *
 * So each polygon is right after every step, in whatever order edges come; only how few faces remain depends on the
 * order.
 */
#pragma once

#include "host/geometry/quickhull.h"

namespace tandem {

/* Newell's normal: the sum of the areas of its triangles; its length is twice the polygon's area. */
Vector newell_normal(const std::vector<Vector> &points, const Polygon &polygon);

/* The same cycle from its smallest index. */
void start_at_smallest(Polygon &polygon);

/* False where an edge has not exactly one face on each side, a face fewer than three corners, or V - E + F is not 2. */
bool is_closed_surface(const std::vector<Polygon> &faces);

std::vector<Polygon> merged_faces(const std::vector<Vector> &points, std::vector<Polygon> faces, double tolerance);

} // namespace tandem
