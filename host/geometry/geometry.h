/* geometry.h - the types and checks that the preparation of shapes shares: a point in double, a box, and the refusal of
 * bad input.
 *
 * host/geometry computes from a user's points, triangles and sizes what the shape tables of the kernels need (hulls,
 * masses, adjacency, hierarchies), once, before the simulation. Input and output points are the floats that kernels
 * read; everything between is in double.
 *
 *   points ----> convex_hull ----+
 *                                +--> mass_properties --> mass, centre, principal axes
 *   triangles -> triangle_mesh --+
 *                     +-----------> bvh  (or boxes of anything)
 */
#pragma once

#include <span>

#include <tandem/export.h>
#include <tandem/round_to_float.h>
#include <tandem/scene.h>

namespace tandem {

using Double3 = std::array<double, 3>;
using Rotation = std::array<double, 4>;   /* x y z w, unit length */
using Triangle = std::array<uint32_t, 3>; /* indices of vertices, counter-clockwise seen from outside */

/* An axis-aligned box: all x with lower <= x <= upper. */
struct AxisAlignedBox {
  Vec3 lower{}, upper{};
  bool operator==(const AxisAlignedBox &) const = default;
};

/* The bounds of at least one point. */
AxisAlignedBox bounds_of(std::span<const Vec3> points);

/* The points with their coordinates multiplied axis by axis. A negative factor mirrors: the hull of the points stays
 * valid, but triangles are inside out afterwards. Throws InputError if a factor is zero or not finite. */
TANDEM_API std::vector<Vec3> scaled(std::span<const Vec3> points, const Vec3 &scale, const std::string &where);

/* The points without duplicates, in the order of their first appearance. Negative zeros become zeros. */
struct DistinctPoints {
  std::vector<Vec3> points;
  std::vector<uint32_t> index; /* for each given point, its index in `points` */
};
DistinctPoints distinct(std::span<const Vec3> points);

/* Throws InputError that names the first point that is NaN or infinite; `what` is "point" or "vertex". */
void require_finite(std::span<const Vec3> points, const char *what, const std::string &where);

/* The largest size, or coordinate within a body, in metres: the products that the stages form of it stay finite
 * floats. */
inline constexpr float longest_length = 1e9f;

/* Throws as require_finite does, and also for the first point with a coordinate beyond longest_length. */
void require_within_reach(std::span<const Vec3> points, const char *what, const std::string &where);

inline Vec3 rounded(const Point &p) { return {round_to_float(p[0]), round_to_float(p[1]), round_to_float(p[2])}; }

} // namespace tandem
