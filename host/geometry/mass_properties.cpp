/* mass_properties.cpp - see mass_properties.h. */
#include "host/geometry/mass_properties.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>

#include "host/geometry/vector.h"

namespace tandem {
namespace {

using Matrix = Eigen::Matrix3d;

Matrix matrix_of(const SymmetricMatrix &m)
{
  Matrix result;
  result << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  return result;
}

SymmetricMatrix symmetric(const Matrix &m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}; }

/* The inertia tensor of a point mass, and of a covariance (the integral of x x^T dm). */
Matrix inertia_of_covariance(const Matrix &covariance) { return covariance.trace() * Matrix::Identity() - covariance; }
Matrix inertia_of_point(const Vector &at) { return inertia_of_covariance(at * at.transpose()); }

/* A slice of a solid of revolution: y from `from` to `to` seen from `origin`; squared_radius is a polynomial of second degree. */
template <class SquaredRadius> MassProperties slice(double origin, double from, double to, const SquaredRadius &squared_radius)
{
  /* Gauss-Legendre's three points are exact up to the fifth degree, the integrands are of the fourth, and none cancels. */
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
  Vector sum = Vector::Zero();
  const Vector base = vector_of(vertices[0]);
  for (const Vec3 &v : vertices) sum += vector_of(v) - base;
  return base + sum / double(vertices.size());
}

Eigen::Quaterniond quaternion_of(const std::array<double, 4> &q) { return {q[3], q[0], q[1], q[2]}; }

/* Columns: an axis of the principal frame each, of unit length. The best of the 24 ways to name them x y z, right-handed. */
Matrix named_least_turned(const Matrix &axes)
{
  static constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  Matrix best = Matrix::Identity();
  double best_trace = -4; /* a rotation by a has the trace 1 + 2 cos a */
  for (const auto &order : orders)
    for (int signs = 0; signs < 8; ++signs) {
      Matrix candidate;
      for (int i = 0; i < 3; ++i) candidate.col(i) = axes.col(order[i]) * ((signs >> i & 1) ? -1 : 1);
      if (candidate.determinant() < 0 || candidate.trace() <= best_trace + 1e-9) continue; /* of equals, the first */
      best_trace = candidate.trace();
      best = candidate;
    }
  return best;
}

/* Two moments are equal: the third's axis alone is given. The smallest turn that brings an axis of the shape there. */
Matrix turned_onto(const Vector &axis)
{
  int nearest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) > std::abs(axis[nearest])) nearest = i;
  const Vector target = axis[nearest] < 0 ? Vector(-axis) : axis;
  return Eigen::Quaterniond::FromTwoVectors(Vector(Vector::Unit(nearest)), target).toRotationMatrix();
}

Matrix least_turned_frame(const Matrix &inertia)
{
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(inertia);
  const Vector moments = solver.eigenvalues(); /* ascending */
  const double equal = principal_tolerance * moments[2];
  const bool lower_equal = moments[1] - moments[0] <= equal, upper_equal = moments[2] - moments[1] <= equal;
  if (lower_equal && upper_equal) return Matrix::Identity();
  if (lower_equal) return turned_onto(solver.eigenvectors().col(2));
  if (upper_equal) return turned_onto(solver.eigenvectors().col(0));
  return named_least_turned(solver.eigenvectors());
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
  /* Normals of the side rise with this sine, so it touches each sphere that far above its centre, in radii. */
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
  Vector first = Vector::Zero();
  Matrix second = Matrix::Zero();
  for (const Triangle &t : triangles) {
    const Vector a = vector_of(vertices[t[0]]) - origin, b = vector_of(vertices[t[1]]) - origin, c = vector_of(vertices[t[2]]) - origin;
    const Vector sum = a + b + c;
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    first += part / 4 * sum;
    second += part / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (volume == 0) return {};
  const Vector center = first / volume;
  return {volume, array_of(origin + center), symmetric(inertia_of_covariance(second) - volume * inertia_of_point(center))};
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
    throw InputError(fmt::format("{}: a flat mesh of {} triangles has no volume; give the body mass and inertia, or make it fixed", where,
                                 mesh.triangles.size()));
  const MassProperties result = polyhedron_mass(mesh.vertices, mesh.triangles);
  if (!(result.mass > 0))
    throw InputError(fmt::format("{}: the volume of the mesh is {}, its triangles are inside out; turn them counter-clockwise seen from outside",
                                 where, result.mass));
  return result;
}

MassProperties with_mass(const MassProperties &shape, double mass)
{
  return {mass, shape.center, symmetric(matrix_of(shape.inertia) * (mass / shape.mass))};
}

MassProperties placed(const MassProperties &shape, const std::array<double, 4> &rotation, const Double3 &position)
{
  const Matrix turn = quaternion_of(rotation).toRotationMatrix();
  return {shape.mass, array_of(turn * vector_of(shape.center) + vector_of(position)),
          symmetric(turn * matrix_of(shape.inertia) * turn.transpose())};
}

MassProperties compound_mass(std::span<const MassProperties> parts)
{
  MassProperties sum;
  Vector center = Vector::Zero();
  for (const MassProperties &part : parts) {
    sum.mass += part.mass;
    center += part.mass * vector_of(part.center);
  }
  center /= sum.mass;
  Matrix inertia = Matrix::Zero();
  for (const MassProperties &part : parts)
    inertia += matrix_of(part.inertia) + part.mass * inertia_of_point(vector_of(part.center) - center);
  return {sum.mass, array_of(center), symmetric(inertia)};
}

PrincipalAxes principal_axes(const SymmetricMatrix &inertia)
{
  const Matrix tensor = matrix_of(inertia), frame = least_turned_frame(tensor);
  Eigen::Quaterniond rotation(frame);
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  return {array_of(Vector((frame.transpose() * tensor * frame).diagonal())), {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

} // namespace tandem
