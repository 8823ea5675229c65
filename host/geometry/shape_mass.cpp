/* shape_mass.cpp - mass properties of each type of shape, and moves of the body frame to the principal axes; see
 * shape_mass.h. */
#include "host/geometry/shape_mass.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tandem/round_to_float.h>

#include "host/geometry/rotation.h"

namespace tandem {
namespace {

/* Relative to a shape's size. A centre of mass nearer to the shape's origin, or a rotation smaller than
 * principal_tolerance, is a rounding error of its floats. */
constexpr double center_rounding = 0x1p-24;
/* Relative to the largest moment. The tolerance admits roundings and quaternions written with four digits, and finds
 * mistakes. */
constexpr double axes_tolerance = 1e-3;

Rotation widened(const Quat &q) { return unit(Rotation{q[0], q[1], q[2], q[3]}); }
Double3 widened(const Vec3 &v) { return {v[0], v[1], v[2]}; }

/* Replaces components that are only rounding residue of cancelled terms by zero. */
template <size_t n> std::array<float, n> without_residue(const std::array<double, n> &values)
{
  double largest = 0;
  for (double x : values) largest = std::max(largest, std::abs(x));
  std::array<float, n> result;
  for (size_t i = 0; i < n; ++i) result[i] = std::abs(values[i]) <= 1e-14 * largest ? 0.0f : round_to_float(values[i]);
  return result;
}

double largest_of(const Shape &shape)
{
  double largest = 0;
  const auto take = [&](const Vec3 &v) {
    for (float x : v) largest = std::max(largest, double(std::abs(x)));
  };
  if (shape.compound)
    for (const Child &child : shape.compound->children) {
      take(child.position);
      largest = std::max(largest, largest_of(child.shape));
    }
  else if (shape.hull || shape.mesh)
    for (const Vec3 &v : shape.hull ? shape.hull->vertices : shape.mesh->vertices) take(v);
  else take(shape.size);
  return largest;
}

MassProperties mass_of_children(const Compound &compound)
{
  std::vector<MassProperties> parts;
  for (const Child &child : compound.children) {
    const MassProperties own = mass_properties_of(child.shape);
    parts.push_back(
        placed(with_mass(own, own.mass * child.density), widened(child.orientation), widened(child.position)));
  }
  return compound_mass(parts);
}

} // namespace

Rotation product(const Rotation &a, const Rotation &b) { return product_of(unit(a), unit(b)); }
Double3 turned(const Rotation &rotation, const Double3 &v) { return array_of(turn(unit(rotation), vector_of(v))); }

/* Repeats the hull of its own vertices until it leaves none of them out: the vertices alone then determine it, faces
 * included, and a scene file stores only them. */
Shape hull_shape(std::span<const Vec3> points, const std::string &where)
{
  ConvexHull hull = convex_hull(points, where);
  for (size_t before = distinct(points).points.size(); before != hull.vertices.size();) {
    before = hull.vertices.size();
    hull = convex_hull(hull.vertices, where);
  }
  return {ShapeType::hull, {0, 0, 0}, std::make_shared<const ConvexHull>(std::move(hull))};
}

MassProperties mass_properties_of(const Shape &shape)
{
  const double a = shape.size[0], b = shape.size[1], c = shape.size[2];
  switch (shape.type) {
  case ShapeType::sphere: return sphere_mass(a);
  case ShapeType::box: return box_mass({a, b, c});
  case ShapeType::capsule: return capsule_mass(a, c, 2 * b);
  case ShapeType::cylinder: return cylinder_mass(a, c, 2 * b);
  case ShapeType::hull: return hull_mass(*shape.hull);
  case ShapeType::mesh: return mesh_mass(*shape.mesh, "a mesh");
  case ShapeType::compound: return mass_of_children(*shape.compound);
  case ShapeType::half_space: break;
  }
  throw std::logic_error("a shape without mass");
}

bool has_volume(const Shape &shape)
{
  if (shape.type == ShapeType::half_space) return false;
  if (shape.compound)
    return std::all_of(shape.compound->children.begin(), shape.compound->children.end(),
                       [](const Child &child) { return has_volume(child.shape); });
  return !shape.mesh || (!shape.mesh->flat && polyhedron_mass(shape.mesh->vertices, shape.mesh->triangles).mass > 0);
}

PrincipalFrame principal_frame_of(const Shape &shape)
{
  const MassProperties solid = mass_properties_of(shape);
  const PrincipalAxes axes = principal_axes(solid.inertia);
  PrincipalFrame frame{solid.mass, solid.center, axes.rotation, axes.moments};
  const double rounding = center_rounding * largest_of(shape);
  const auto &[x, y, z] = frame.center;
  if (std::max({std::abs(x), std::abs(y), std::abs(z)}) <= rounding) frame.center = {};
  if (Vector(axes.rotation[0], axes.rotation[1], axes.rotation[2]).norm() <= principal_tolerance)
    frame.rotation = {0, 0, 0, 1};
  return frame;
}

ShapePlace place_of_shape(const Body &body)
{
  const Rotation orientation = widened(body.orientation);
  const Vector offset = vector_of(turned(orientation, widened(body.shape_position)));
  return {array_of(vector_of(body.position) + offset), product(orientation, widened(body.shape_orientation))};
}

ShapePlace place_of_child(const Body &body, const Child &child)
{
  const Rotation orientation = widened(body.shape_orientation);
  const Vector offset = vector_of(turned(orientation, widened(child.position)));
  return {array_of(vector_of(body.shape_position) + offset), product(orientation, widened(child.orientation))};
}

std::vector<Vec3> placed_points(std::span<const Vec3> points, const Vec3 &position, const Quat &orientation)
{
  std::vector<Vec3> placed;
  const Rotation rotation = widened(orientation);
  for (const Vec3 &p : points) placed.push_back(rounded(array_of(turn(rotation, vector_of(p)) + vector_of(position))));
  return placed;
}

/* The pose of the shape in the body is rounded to floats first; the body's position, in double, then compensates for
 * the rounding. */
void move_frame(Body &body, const Double3 &position, const Rotation &orientation)
{
  const ShapePlace place = place_of_shape(body);
  body.orientation = without_residue(unit(orientation));
  const Rotation rotation = widened(body.orientation);
  body.shape_orientation = without_residue(product_of(inverse(rotation), unit(place.orientation)));
  body.shape_position =
      without_residue(array_of(turn(inverse(rotation), vector_of(place.position) - vector_of(position))));
  body.position = array_of(vector_of(place.position) - turn(rotation, vector_of(body.shape_position)));
}

bool has_principal_axes(const Body &body, const Shape &shape)
{
  const PrincipalFrame frame = principal_frame_of(shape);
  const auto &[x, y, z] = frame.moments;
  const Matrix axes = rotation_matrix(product(widened(body.shape_orientation), frame.rotation)),
               expected = Matrix::diagonal(x, y, z);
  const Matrix difference = axes * expected * axes.transposed() - expected;
  double largest = 0;
  for (const auto &row : difference.at)
    for (double entry : row) largest = std::max(largest, std::abs(entry));
  return largest <= axes_tolerance * std::max({x, y, z});
}

Vec3 inertia_of(const Shape &shape, float mass)
{
  const double m = mass, x = shape.size[0], y = shape.size[1], z = shape.size[2];
  switch (shape.type) {
  case ShapeType::half_space: return {0, 0, 0};
  case ShapeType::sphere: {
    const float moment = round_to_float(0.4 * m * x * x);
    return {moment, moment, moment};
  }
  case ShapeType::box:
    return {round_to_float(m / 3 * (y * y + z * z)), round_to_float(m / 3 * (x * x + z * z)),
            round_to_float(m / 3 * (x * x + y * y))};
  default: break;
  }
  const PrincipalFrame frame = principal_frame_of(shape);
  Vec3 moments;
  for (size_t axis = 0; axis < 3; ++axis) moments[axis] = round_to_float(frame.moments[axis] * (m / frame.mass));
  return moments;
}

void take_mass_properties(const Scene &scene, Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  if (shape.type == ShapeType::half_space) return;
  const PrincipalFrame frame = principal_frame_of(shape);
  const Body untouched;
  const bool own =
      body.shape_position == untouched.shape_position && body.shape_orientation == untouched.shape_orientation;
  if (own && frame.center == Double3{} && frame.rotation == Rotation{0, 0, 0, 1}) return;
  const ShapePlace place = place_of_shape(body);
  const Vector center = vector_of(place.position) + vector_of(turned(place.orientation, frame.center));
  move_frame(body, array_of(center), product(place.orientation, frame.rotation));
}

} // namespace tandem
