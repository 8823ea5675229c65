/* convex_hull.h - the convex hull of points, as polygons with planes and edges.
 *
 * host/geometry/quickhull.h finds the exact hull in integers; this file merges its triangles into few, large faces,
 * which contact generation needs. The cap of a cylinder becomes one polygon and not a fan, so that its manifold
 * consists of rim points and no contact appears at an edge between coplanar triangles.
 *
 *       exact hull                Faces within the tolerance of one plane are joined, the flattest edge first, as long
 *      +----+      +----+         as the polygon stays convex. Points that then lie in no more than two faces are
 *      | \  |  ->  |    |         within the tolerance of an edge or face and are left out. Every vertex therefore has
 *      |  \ |      |    |         three faces or more, and V - E + F = 2.
 *      +----+      +----+
 *
 * The result depends only on the points and their order, to the bit on every machine: vertices keep the order of the
 * input, faces start at their smallest vertex and are sorted, and so are edges. The construction is meant for hulls of
 * up to some ten thousand vertices, which take a second.
 */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

/* The plane of a face: normal . x <= distance for all x of the hull. */
struct HullPlane {
  Double3 normal{}; /* unit, outward */
  double distance = 0;
};

/* An edge from v0 to v1 > v0. Seen from outside with v1 above v0, its faces are on the left and on the right; the left
 * one lists v0, v1 in this order, the right one v1, v0. */
struct HullEdge {
  uint32_t v0, v1, face_left, face_right;
  bool operator==(const HullEdge &) const = default;
};

struct ConvexHull {
  std::vector<Vec3> vertices;               /* each one of the given points */
  std::vector<std::vector<uint32_t>> faces; /* convex polygons, counter-clockwise seen from outside */
  std::vector<HullPlane> planes; /* one for each face, from the float vertices; each passes through the vertex that is
                                    farthest along its normal */
  std::vector<HullEdge> edges;   /* sorted by v0, v1 */
  Double3 centroid{};            /* centre of the volume */
  double tolerance = 0;          /* m: hull_tolerance_of(points) */
};

/* How far from their plane the vertices of a face may lie, relative to the longest side of the points' bounds. It is
 * never less than the rounding error of the input: hull_rounding times the largest coordinate (four roundings). No
 * input point lies farther outside a plane than hull_outside times the tolerance. */
constexpr double hull_tolerance = 1e-6, hull_rounding = 0x1p-22, hull_outside = 4;
double hull_tolerance_of(std::span<const Vec3> points);

/* Takes any number of points. Throws InputError for fewer than four different ones, for points that lie in one place,
 * line or plane (within the tolerance), and for points that are not finite. */
ConvexHull convex_hull(std::span<const Vec3> points, const std::string &where);

/* The hull moved by `offset`, for example to make its centre of mass the origin. Vertices are rounded to float, and
 * planes are computed from them. */
ConvexHull translated(const ConvexHull &hull, const Double3 &offset);

/* The radius of the smallest ball about `center` that contains the hull. */
double radius_about(const ConvexHull &hull, const Double3 &center);

} // namespace tandem
