/* mass_properties.cpp - volume integrals of solids, and the diagonalisation of inertia tensors; see
 * mass_properties.h. */
#include "host/geometry/mass_properties.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "host/geometry/rotation.h"

namespace tandem {
namespace {

Matrix matrix_of(const SymmetricMatrix &m) { return {{{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}}; }

SymmetricMatrix symmetric(const Matrix &m)
{
  return {m.at[0][0], m.at[1][1], m.at[2][2], m.at[0][1], m.at[0][2], m.at[1][2]};
}

/* The inertia tensor of a covariance (the integral of x x^T dm). */
Matrix inertia_of_covariance(const Matrix &covariance)
{
  const double trace = covariance.trace();
  return Matrix::diagonal(trace, trace, trace) - covariance;
}
Matrix inertia_of_point(const Vector &at) { return inertia_of_covariance(Matrix::outer(at, at)); }

/* The slice of a solid of revolution between the heights `from` and `to`, relative to `origin`; squared_radius is a
 * polynomial of second degree. */
template <class SquaredRadius>
MassProperties slice(double origin, double from, double to, const SquaredRadius &squared_radius)
{
  /* Gauss-Legendre quadrature with three points is exact up to the fifth degree. The integrands are of the fourth, and
   * no terms cancel. */
  const double node = std::sqrt(0.6), middle = (from + to) / 2, half = (to - from) / 2;
  double mass = 0, first = 0, second = 0, across = 0;
  for (const auto &[place, weight] : {std::pair{-node, 5.0 / 9}, {0.0, 8.0 / 9}, {node, 5.0 / 9}}) {
    const double y = half * place, area = std::numbers::pi * squared_radius(middle + y);
    const double dm = weight * half * area;
    mass += dm;
    first += dm * y;
    second += dm * y * y;
    across += dm * squared_radius(middle + y) / 4;
  }
  if (mass == 0) return {};
  const double offset = first / mass, about = across + (second - mass * offset * offset);
  return {mass, {0, origin + middle + offset, 0}, {about, 2 * across, about, 0, 0, 0}};
}

MassProperties spherical_slice(double center, double radius, double from, double to)
{
  return slice(center, from, to, [radius](double y) { return (radius - y) * (radius + y); });
}

MassProperties conical_slice(double from, double to, double radius_from, double radius_to)
{
  return slice(0, from, to, [=](double y) {
    const double along = (y - from) / (to - from), radius = radius_from + (radius_to - radius_from) * along;
    return radius * radius;
  });
}

Vector center_of(std::span<const Vec3> vertices)
{
  Vector sum;
  const Vector base = vector_of(vertices[0]);
  for (const Vec3 &v : vertices) sum += vector_of(v) - base;
  return base + sum / double(vertices.size());
}

/* The eigenvalues of a symmetric matrix, ascending, and the axis of each. */
struct Eigensystem {
  std::array<double, 3> moments;
  std::array<Vector, 3> axes;
};

/* Rotates x and y so that the matrix has no entry at p, q (Jacobi's rotation). */
void rotate_away(Matrix &m, Matrix &axes, int p, int q)
{
  const double slope = (m.at[q][q] - m.at[p][p]) / (2 * m.at[p][q]);
  const double tangent = (slope < 0 ? -1 : 1) / (std::abs(slope) + std::sqrt(slope * slope + 1));
  const double cosine = 1 / std::sqrt(tangent * tangent + 1), sine = tangent * cosine;
  Matrix turn = Matrix::diagonal(1, 1, 1);
  turn.at[p][p] = turn.at[q][q] = cosine;
  turn.at[p][q] = sine;
  turn.at[q][p] = -sine;
  m = turn.transposed() * m * turn;
  m.at[p][q] = m.at[q][p] = 0;
  axes = axes * turn;
}

/* Jacobi's eigenvalue method, which is accurate for small moments beside large ones; it converges quadratically. */
Eigensystem eigensystem_of(Matrix m)
{
  constexpr int most_iterations = 30;
  constexpr double negligible = 0x1p-60;
  Matrix axes = Matrix::diagonal(1, 1, 1);
  bool changed = true;
  for (int iteration = 0; iteration < most_iterations && changed; ++iteration) {
    changed = false;
    for (const auto &[p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}})
      if (std::abs(m.at[p][q]) > negligible * (std::abs(m.at[p][p]) + std::abs(m.at[q][q]))) {
        rotate_away(m, axes, p, q);
        changed = true;
      }
  }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return m.at[i][i] < m.at[j][j]; });
  const auto &[low, middle, high] = order;
  return {{m.at[low][low], m.at[middle][middle], m.at[high][high]},
          {axes.column(low), axes.column(middle), axes.column(high)}};
}

/* The axes of the principal frame, of unit length, in the right-handed one of the 24 orders and signs that is rotated
 * least from the shape's axes. */
Matrix named_least_turned(const std::array<Vector, 3> &axes)
{
  static constexpr size_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  Matrix best = Matrix::diagonal(1, 1, 1);
  double best_trace = -4; /* a rotation by a has the trace 1 + 2 cos a */
  for (const auto &order : orders)
    for (int signs = 0; signs < 8; ++signs) {
      const auto column = [&](int i) { return (signs >> i & 1 ? -1.0 : 1.0) * axes[order[i]]; };
      const Matrix candidate = Matrix::of_columns(column(0), column(1), column(2));
      if (candidate.determinant() < 0 || candidate.trace() <= best_trace + 1e-9) continue; /* of equals, the first */
      best_trace = candidate.trace();
      best = candidate;
    }
  return best;
}

/* If two moments are equal, only the axis of the third is determined. The result is the smallest rotation that turns an
 * axis of the shape onto it. */
Matrix turned_onto(const Vector &axis)
{
  const double size[3] = {std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)};
  const int nearest = size[1] > size[0] ? (size[2] > size[1] ? 2 : 1) : (size[2] > size[0] ? 2 : 0);
  const Vector from(nearest == 0, nearest == 1, nearest == 2), to = axis.dot(from) < 0 ? -axis : axis,
                                                               about = from.cross(to);
  return rotation_matrix(unit(Rotation{about.x, about.y, about.z, 1 + from.dot(to)}));
}

Matrix least_turned_frame(const Matrix &inertia)
{
  const auto [moments, axes] = eigensystem_of(inertia);
  const double equal = principal_tolerance * moments[2];
  const bool lower_equal = moments[1] - moments[0] <= equal, upper_equal = moments[2] - moments[1] <= equal;
  if (lower_equal && upper_equal) return Matrix::diagonal(1, 1, 1);
  if (lower_equal) return turned_onto(axes[2]);
  if (upper_equal) return turned_onto(axes[0]);
  return named_least_turned(axes);
}

} // namespace

MassProperties sphere_mass(double radius)
{
  const double mass = 4 * std::numbers::pi / 3 * radius * radius * radius, moment = 0.4 * mass * radius * radius;
  return {mass, {}, {moment, moment, moment, 0, 0, 0}};
}

MassProperties box_mass(const Double3 &half_extents)
{
  const double x = half_extents[0], y = half_extents[1], z = half_extents[2], mass = 8 * x * y * z;
  return {mass, {}, {mass * (y * y + z * z) / 3, mass * (x * x + z * z) / 3, mass * (x * x + y * y) / 3, 0, 0, 0}};
}

MassProperties cylinder_mass(double radius_bottom, double radius_top, double height)
{
  return conical_slice(-height / 2, height / 2, radius_bottom, radius_top);
}

MassProperties capsule_mass(double radius_bottom, double radius_top, double height)
{
  const double bottom = -height / 2, top = height / 2;
  if (std::abs(radius_bottom - radius_top) >= height) {
    const MassProperties larger = sphere_mass(std::max(radius_bottom, radius_top));
    return placed(larger, {0, 0, 0, 1}, {0, radius_bottom > radius_top ? bottom : top, 0});
  }
  /* The normals of the side rise with this sine, so the side touches each sphere that far above its centre, in
   * radii. */
  const double sine = (radius_bottom - radius_top) / height, cosine = std::sqrt((1 - sine) * (1 + sine));
  const double touch_bottom = radius_bottom * sine, touch_top = radius_top * sine;
  const MassProperties parts[] = {
      spherical_slice(bottom, radius_bottom, -radius_bottom, touch_bottom),
      conical_slice(bottom + touch_bottom, top + touch_top, radius_bottom * cosine, radius_top * cosine),
      spherical_slice(top, radius_top, touch_top, radius_top)};
  return compound_mass(parts);
}

MassProperties polyhedron_mass(std::span<const Vec3> vertices, std::span<const Triangle> triangles)
{
  const Vector origin = center_of(vertices);
  double volume = 0;
  Vector first;
  Matrix second;
  for (const Triangle &t : triangles) {
    const Vector a = vector_of(vertices[t[0]]) - origin, b = vector_of(vertices[t[1]]) - origin,
                 c = vector_of(vertices[t[2]]) - origin;
    const Vector sum = a + b + c;
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    first += part / 4 * sum;
    second = second +
             part / 20 * (Matrix::outer(a, a) + Matrix::outer(b, b) + Matrix::outer(c, c) + Matrix::outer(sum, sum));
  }
  if (volume == 0) return {};
  const Vector center = first / volume;
  return {volume, array_of(origin + center),
          symmetric(inertia_of_covariance(second) - volume * inertia_of_point(center))};
}

MassProperties hull_mass(const ConvexHull &hull)
{
  std::vector<Triangle> triangles;
  for (const auto &face : hull.faces)
    for (size_t i = 2; i < face.size(); ++i) triangles.push_back({face[0], face[i - 1], face[i]});
  return polyhedron_mass(hull.vertices, triangles);
}

MassProperties mesh_mass(const TriangleMesh &mesh, const std::string &where)
{
  if (mesh.flat)
    throw InputError(
        fmt::format("{}: a flat mesh of {} triangles has no volume; give the body mass and inertia, or make it fixed",
                    where, mesh.triangles.size()));
  const MassProperties result = polyhedron_mass(mesh.vertices, mesh.triangles);
  if (!(result.mass > 0))
    throw InputError(fmt::format(
        "{}: the volume of the mesh is {}, its triangles are inside out; turn them counter-clockwise seen from outside",
        where, result.mass));
  return result;
}

MassProperties with_mass(const MassProperties &shape, double mass)
{
  return {mass, shape.center, symmetric(mass / shape.mass * matrix_of(shape.inertia))};
}

MassProperties placed(const MassProperties &shape, const std::array<double, 4> &rotation, const Double3 &position)
{
  const Matrix turn = rotation_matrix(rotation);
  return {shape.mass, array_of(turn * vector_of(shape.center) + vector_of(position)),
          symmetric(turn * matrix_of(shape.inertia) * turn.transposed())};
}

MassProperties compound_mass(std::span<const MassProperties> parts)
{
  MassProperties sum;
  Vector center;
  for (const MassProperties &part : parts) {
    sum.mass += part.mass;
    center += part.mass * vector_of(part.center);
  }
  center = center / sum.mass;
  Matrix inertia;
  for (const MassProperties &part : parts)
    inertia = inertia + (matrix_of(part.inertia) + part.mass * inertia_of_point(vector_of(part.center) - center));
  return {sum.mass, array_of(center), symmetric(inertia)};
}

PrincipalAxes principal_axes(const SymmetricMatrix &inertia)
{
  const Matrix tensor = matrix_of(inertia), frame = least_turned_frame(tensor),
               diagonal = frame.transposed() * tensor * frame;
  return {{diagonal.at[0][0], diagonal.at[1][1], diagonal.at[2][2]}, rotation_of(frame)};
}

} // namespace tandem
