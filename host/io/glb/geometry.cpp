/* geometry.cpp - tessellates shapes for display; see geometry.h. */
#include "host/io/glb/geometry.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/shape_mass.h"

namespace tandem {
namespace {

/* Scales a unit mesh by the half extents. Normals stay unchanged, because balls are scaled evenly and the faces of
 * boxes are perpendicular to the axes. */
void stretch(DisplayMesh &mesh, const Vec3 &size)
{
  for (Vec3 &p : mesh.positions)
    for (size_t axis = 0; axis < 3; ++axis) p[axis] *= size[axis];
}

Vec3 unit_normal(const Vec3 &a, const Vec3 &b, const Vec3 &c)
{
  double u[3], v[3];
  for (size_t k = 0; k < 3; ++k) {
    u[k] = double(b[k]) - a[k];
    v[k] = double(c[k]) - a[k];
  }
  const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0],
               length = std::hypot(x, y, z);
  return {round_to_float(x / length), round_to_float(y / length), round_to_float(z / length)};
}

constexpr double pi = 3.14159265358979323846;
constexpr int segments = 24; /* of a circle */

void add_quad(DisplayMesh &mesh, const std::array<Vec3, 4> &corners, const Vec3 &normal)
{
  auto first = uint32_t(mesh.positions.size());
  for (const Vec3 &corner : corners) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
  }
  for (int corner : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(uint32_t(first + corner));
}

DisplayMesh box_mesh()
{
  DisplayMesh mesh;
  for (size_t axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f}) {
      size_t u = (axis + 1) % 3, v = (axis + 2) % 3; /* u × v = axis */
      Vec3 normal{0, 0, 0};
      normal[axis] = side;
      std::array<Vec3, 4> corners;
      const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (size_t i = 0; i < 4; ++i) {
        corners[i][axis] = side;
        corners[i][u] = side * signs[i][0]; /* mirrored on the opposite side, which reverses the winding */
        corners[i][v] = signs[i][1];
      }
      add_quad(mesh, corners, normal);
    }
  return mesh;
}

DisplayMesh sphere_mesh()
{
  constexpr int rings = 12;
  DisplayMesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      double polar = pi * ring / rings, azimuth = 2 * pi * segment / segments;
      Vec3 point{round_to_float(std::sin(polar) * std::cos(azimuth)), round_to_float(std::cos(polar)),
                 round_to_float(std::sin(polar) * std::sin(azimuth))};
      mesh.positions.push_back(point);
      mesh.normals.push_back(point);
    }
  auto vertex = [](int ring, int segment) { return uint32_t(ring * (segments + 1) + segment); };
  for (int ring = 0; ring < rings; ++ring)
    for (int s = 0; s < segments; ++s) {
      /* At the poles one triangle of each quad has no area. */
      if (ring > 0)
        mesh.indices.insert(mesh.indices.end(), {vertex(ring, s), vertex(ring, s + 1), vertex(ring + 1, s)});
      if (ring < rings - 1)
        mesh.indices.insert(mesh.indices.end(), {vertex(ring, s + 1), vertex(ring + 1, s + 1), vertex(ring + 1, s)});
    }
  return mesh;
}

/* --- solids of revolution ------------------------------------------------------------------------
 *
 *   y ^  _          Rings along the profile from the top down, each with the normal there: (across, along Y).
 *     | / \         A ring of radius 0 is a pole. At a corner of the profile, such as the rim of a cylinder, there
 *     ||   |        are two rings with a normal each, and no triangles between them.
 *     | \_/
 */
struct Ring {
  double radius, y;
  double across, along; /* of the normal; unit */
};

DisplayMesh revolved(const std::vector<Ring> &rings)
{
  DisplayMesh mesh;
  for (const Ring &ring : rings)
    for (int segment = 0; segment <= segments; ++segment) {
      const double azimuth = 2 * pi * segment / segments, x = std::cos(azimuth), z = std::sin(azimuth);
      mesh.positions.push_back(
          {round_to_float(ring.radius * x), round_to_float(ring.y), round_to_float(ring.radius * z)});
      mesh.normals.push_back(
          {round_to_float(ring.across * x), round_to_float(ring.along), round_to_float(ring.across * z)});
    }
  const auto vertex = [](size_t ring, int segment) { return uint32_t(ring * (segments + 1) + size_t(segment)); };
  for (size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    const Ring &upper = rings[ring], &lower = rings[ring + 1];
    if (upper.radius == lower.radius && upper.y == lower.y) continue;
    for (int s = 0; s < segments; ++s) {
      if (upper.radius > 0)
        mesh.indices.insert(mesh.indices.end(), {vertex(ring, s), vertex(ring, s + 1), vertex(ring + 1, s)});
      if (lower.radius > 0)
        mesh.indices.insert(mesh.indices.end(), {vertex(ring, s + 1), vertex(ring + 1, s + 1), vertex(ring + 1, s)});
    }
  }
  return mesh;
}

DisplayMesh cylinder_mesh(const Vec3 &size)
{
  const double bottom = size[0], half_height = size[1], top = size[2], side = std::hypot(2 * half_height, bottom - top);
  const double across = 2 * half_height / side, along = (bottom - top) / side;
  std::vector<Ring> rings;
  if (top > 0) rings.insert(rings.end(), {{0, half_height, 0, 1}, {top, half_height, 0, 1}});
  rings.insert(rings.end(), {{top, half_height, across, along}, {bottom, -half_height, across, along}});
  if (bottom > 0) rings.insert(rings.end(), {{bottom, -half_height, 0, -1}, {0, -half_height, 0, -1}});
  return revolved(rings);
}

/* Appends rings on a sphere from one polar angle to another; poles are exactly on the axis. */
void append_cap(std::vector<Ring> &rings, double radius, double y, double from, double to)
{
  const int steps = std::max(1, int(std::ceil((to - from) / (pi / 12) - 1e-9)));
  for (int step = 0; step <= steps; ++step) {
    const double polar = from + (to - from) * step / steps, across = polar == 0 || polar == pi ? 0 : std::sin(polar),
                 along = std::cos(polar);
    rings.push_back({radius * across, y + radius * along, across, along});
  }
}

/* The sides touch both spheres at the same polar angle. */
DisplayMesh capsule_mesh(const Vec3 &size)
{
  const double bottom = size[0], half_height = size[1], top = size[2];
  const double touch = std::acos(std::clamp((bottom - top) / (2 * half_height), -1.0, 1.0));
  std::vector<Ring> rings;
  append_cap(rings, top, half_height, 0, touch);
  append_cap(rings, bottom, -half_height, touch, pi);
  return revolved(rings);
}

DisplayMesh hull_mesh(const ConvexHull &hull)
{
  DisplayMesh mesh;
  for (size_t face = 0; face < hull.faces.size(); ++face) {
    const auto first = uint32_t(mesh.positions.size());
    const Double3 &n = hull.planes[face].normal;
    for (uint32_t corner : hull.faces[face]) {
      mesh.positions.push_back(hull.vertices[corner]);
      mesh.normals.push_back({round_to_float(n[0]), round_to_float(n[1]), round_to_float(n[2])});
    }
    for (uint32_t i = 2; i < hull.faces[face].size(); ++i)
      mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
  }
  return mesh;
}

/* Triangles are shaded flat, because a mesh need not be smooth anywhere. */
DisplayMesh surface_mesh(const TriangleMesh &surface)
{
  DisplayMesh mesh;
  for (const Triangle &triangle : surface.triangles) {
    const auto &[a, b, c] = triangle;
    const Vec3 normal = unit_normal(surface.vertices[a], surface.vertices[b], surface.vertices[c]);
    for (uint32_t corner : triangle) {
      mesh.indices.push_back(uint32_t(mesh.positions.size()));
      mesh.positions.push_back(surface.vertices[corner]);
      mesh.normals.push_back(normal);
    }
  }
  return mesh;
}

/* Appends a child at its pose in the compound; a child with a unit mesh is scaled here. */
void append_child(DisplayMesh &mesh, const Child &child)
{
  DisplayMesh own = display_mesh(child.shape);
  if (has_unit_mesh(child.shape.type)) stretch(own, child.shape.size);
  const auto first = uint32_t(mesh.positions.size());
  for (uint32_t index : own.indices) mesh.indices.push_back(first + index);
  for (const Vec3 &p : placed_points(own.positions, child.position, child.orientation)) mesh.positions.push_back(p);
  for (const Vec3 &n : placed_points(own.normals, {0, 0, 0}, child.orientation)) mesh.normals.push_back(n);
}

DisplayMesh compound_mesh(const Compound &compound)
{
  DisplayMesh mesh;
  for (const Child &child : compound.children) append_child(mesh, child);
  return mesh;
}

DisplayMesh half_space_mesh()
{
  DisplayMesh mesh;
  add_quad(mesh, {Vec3{-1, 0, 1}, Vec3{1, 0, 1}, Vec3{1, 0, -1}, Vec3{-1, 0, -1}}, {0, 1, 0});
  return mesh;
}

} // namespace

bool has_unit_mesh(ShapeType type)
{
  return type == ShapeType::sphere || type == ShapeType::box || type == ShapeType::half_space;
}

DisplayMesh display_mesh(const Shape &shape)
{
  switch (shape.type) {
  case ShapeType::sphere: return sphere_mesh();
  case ShapeType::box: return box_mesh();
  case ShapeType::half_space: return half_space_mesh();
  case ShapeType::capsule: return capsule_mesh(shape.size);
  case ShapeType::cylinder: return cylinder_mesh(shape.size);
  case ShapeType::hull: return hull_mesh(*shape.hull);
  case ShapeType::mesh: return surface_mesh(*shape.mesh);
  case ShapeType::compound: return compound_mesh(*shape.compound);
  }
  return {};
}

std::vector<Vec3> outline_points(const Shape &shape)
{
  if (shape.type == ShapeType::half_space) return {};
  if (shape.type == ShapeType::hull) return shape.hull->vertices;
  if (shape.type == ShapeType::mesh) return shape.mesh->vertices;
  DisplayMesh mesh = display_mesh(shape);
  if (has_unit_mesh(shape.type)) stretch(mesh, shape.size);
  return mesh.positions;
}

} // namespace tandem
