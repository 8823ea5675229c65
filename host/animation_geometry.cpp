/* animation_geometry.cpp - see animation_geometry.h. */
#include "host/animation_geometry.h"

#include <cmath>

namespace tandem {
namespace {

constexpr double pi = 3.14159265358979323846;

void add_quad(TriangleMesh &mesh, const std::array<Vec3, 4> &corners, const Vec3 &normal)
{
  auto first = uint16_t(mesh.positions.size());
  for (const Vec3 &corner : corners) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
  }
  for (int corner : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(uint16_t(first + corner));
}

TriangleMesh box_mesh()
{
  TriangleMesh mesh;
  for (size_t axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f}) {
      size_t u = (axis + 1) % 3, v = (axis + 2) % 3; /* u × v = axis */
      Vec3 normal{0, 0, 0};
      normal[axis] = side;
      std::array<Vec3, 4> corners;
      const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (size_t i = 0; i < 4; ++i) {
        corners[i][axis] = side;
        corners[i][u] = side * signs[i][0]; /* mirrored on the far side, which turns the winding round */
        corners[i][v] = signs[i][1];
      }
      add_quad(mesh, corners, normal);
    }
  return mesh;
}

TriangleMesh sphere_mesh()
{
  constexpr int rings = 12, segments = 24;
  TriangleMesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      double polar = pi * ring / rings, azimuth = 2 * pi * segment / segments;
      Vec3 point{float(std::sin(polar) * std::cos(azimuth)), float(std::cos(polar)),
                 float(std::sin(polar) * std::sin(azimuth))};
      mesh.positions.push_back(point);
      mesh.normals.push_back(point);
    }
  auto vertex = [](int ring, int segment) { return uint16_t(ring * (segments + 1) + segment); };
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

} // namespace

TriangleMesh unit_mesh(ShapeType shape)
{
  if (shape == ShapeType::box) return box_mesh();
  if (shape == ShapeType::sphere) return sphere_mesh();
  TriangleMesh mesh;
  add_quad(mesh, {Vec3{-1, 0, 1}, Vec3{1, 0, 1}, Vec3{1, 0, -1}, Vec3{-1, 0, -1}}, {0, 1, 0});
  return mesh;
}

} // namespace tandem
