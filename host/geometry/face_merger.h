/* face_merger.h - joins neighbouring faces of a closed convex surface that lie in one plane within a tolerance. It is
 * the second step of convex_hull.h.
 *
 *      a---b---c        Over each edge, the flattest first, the two faces become one if the polygon
 *      |  /|  /|        - has all corners within the tolerance of one plane (its own and not the neighbour's, so that
 *      | / | / |          errors do not accumulate around a curve),
 *      |/  |/  |        - stays convex: no corner lies deeper than the tolerance behind its neighbours,
 *      d---e---f        - is still one simple cycle.
 *
 * Each polygon is therefore valid after every step, whatever the order of the edges; the order only decides how few
 * faces remain.
 */
#pragma once

#include "host/geometry/quickhull.h"

namespace tandem {

/* Newell's normal: the sum of the area vectors of the polygon's triangles. Its length is twice the polygon's area. */
Vector newell_normal(const std::vector<Vector> &points, const Polygon &polygon);

/* Rotates the cycle so that it begins at its smallest index. */
void start_at_smallest(Polygon &polygon);

/* False if an edge does not have exactly one face on each side, a face has fewer than three corners, or V - E + F is
 * not 2. */
bool is_closed_surface(const std::vector<Polygon> &faces);

std::vector<Polygon> merged_faces(const std::vector<Vector> &points, std::vector<Polygon> faces, double tolerance);

} // namespace tandem
