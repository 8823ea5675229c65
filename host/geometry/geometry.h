/* geometry.h - what the preparation of shapes shares: a point in double, a box, and how bad input is refused.
 *
 * host/geometry turns what a user gives (points, triangles, sizes) into what the tables of shapes need, once, before
 * the simulation: hulls, masses, adjacency, hierarchies. Points come and go as the floats that kernels read; everything
 * between is double.
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

/* Axis-aligned: all x with lower <= x <= upper. */
struct AxisAlignedBox {
  Vec3 lower{}, upper{};
  bool operator==(const AxisAlignedBox &) const = default;
};

/* Of at least one point. */
AxisAlignedBox bounds_of(std::span<const Vec3> points);

/* The points with their coordinates multiplied axis by axis. A negative factor mirrors: a hull of the points takes no
 * notice, triangles are inside out afterwards. Throws InputError where a factor is zero or not finite. */
TANDEM_API std::vector<Vec3> scaled(std::span<const Vec3> points, const Vec3 &scale, const std::string &where);

/* The points without repetitions, in the order of their first appearance. Negative zeros become zeros. */
struct DistinctPoints {
  std::vector<Vec3> points;
  std::vector<uint32_t> index; /* for each given point, its place in `points` */
};
DistinctPoints distinct(std::span<const Vec3> points);

/* Throws InputError naming the first that is NaN or infinite; `what` is "point" or "vertex". */
void require_finite(std::span<const Vec3> points, const char *what, const std::string &where);

/* The farthest that a size, or a place within a body, may reach in metres: what stages multiply of it stays a float. */
inline constexpr float longest_length = 1e9f;

/* The same, and throws for the first with a coordinate beyond longest_length. */
void require_within_reach(std::span<const Vec3> points, const char *what, const std::string &where);

inline Vec3 rounded(const Point &p) { return {round_to_float(p[0]), round_to_float(p[1]), round_to_float(p[2])}; }

} // namespace tandem
