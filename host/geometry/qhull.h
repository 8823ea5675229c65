/* qhull.h - one call of Qhull: the faces of the convex hull of points, as polygons of indices. */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

using Polygon = std::vector<uint32_t>; /* counter-clockwise seen from outside */

/* `merge_within`: faces that are convex by less than this are merged, and points outside by less are left out; 0: Qhull's own
 * bound of rounding. Throws InputError with Qhull's reason, prefixed by `where`. */
std::vector<Polygon> qhull_faces(const std::vector<Double3> &points, double merge_within, const std::string &where);

} // namespace tandem
