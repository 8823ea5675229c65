/* convex_hull.h - the convex hull of points, as polygons with planes and edges.
 *
 * host/geometry/quickhull.h finds the hull in whole numbers, exactly; this file makes of it what contact generation
 * wants: few, large faces. A cylinder's cap is one polygon, not a fan, so that a manifold has its rim and no contact
 * appears at an edge that is not there.
 *
 *       exact hull                faces within the tolerance of one plane are joined, largest agreement first, as long
 *      +----+      +----+         as the polygon stays convex; points that then lie in no more than two faces are
 *      | \  |  ->  |    |         within the tolerance of an edge or face, and are left out. Hence every vertex has
 *      |  \ |      |    |         three faces or more, and V - E + F = 2.
 *      +----+      +----+
 *
 * The result depends on the points and their order alone, to the bit on every machine: vertices stand in the order of
 * the input, faces start at their smallest vertex and are sorted, and so are edges. Meant for hulls of up to some ten
 * thousand vertices, which take a second.
 */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

/* normal . x <= distance for all x of the hull. */
struct HullPlane {
  Double3 normal{}; /* unit, outward */
  double distance = 0;
};

/* Runs from v0 to v1 > v0. Seen from outside with v1 above v0, the faces lie left and right: the left one names v0, v1
 * in this order, the right one v1, v0. */
struct HullEdge {
  uint32_t v0, v1, face_left, face_right;
  bool operator==(const HullEdge &) const = default;
};

struct ConvexHull {
  std::vector<Vec3> vertices;               /* each one of the given points */
  std::vector<std::vector<uint32_t>> faces; /* convex polygons, counter-clockwise seen from outside */
  std::vector<HullPlane> planes; /* of each face, from the float vertices; through the outermost of all of them */
  std::vector<HullEdge> edges;   /* sorted by v0, v1 */
  Double3 centroid{};            /* centre of the volume */
  double tolerance = 0;          /* m: hull_tolerance_of(points) */
};

/* How far from their plane the vertices of a face may lie, in parts of the longest side of the points' bounds; never
 * less than what the floats of the points leave uncertain: hull_rounding times the largest coordinate (four roundings).
 * No point given lies farther outside a plane than hull_outside times the tolerance. */
constexpr double hull_tolerance = 1e-6, hull_rounding = 0x1p-22, hull_outside = 4;
double hull_tolerance_of(std::span<const Vec3> points);

/* Any number of points. Throws InputError for fewer than four different ones, points that lie in one place, line or
 * plane (within the tolerance), or are not finite. */
ConvexHull convex_hull(std::span<const Vec3> points, const std::string &where);

/* The hull moved by `offset`, as when its centre of mass becomes the origin: vertices are rounded to float, planes
 * follow them. */
ConvexHull translated(const ConvexHull &hull, const Double3 &offset);

/* Of the smallest ball about `center` that holds the hull. */
double radius_about(const ConvexHull &hull, const Double3 &center);

} // namespace tandem
