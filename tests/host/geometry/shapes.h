/* shapes.h - points and meshes whose hulls, volumes and edges are known. */
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "host/base/random.h"
#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"
#include "host/geometry/vector.h"

namespace tandem::geometry_test {

inline std::vector<Vec3> box_corners(float x, float y, float z)
{
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z});
  return points;
}

/* The triangles of box_corners, counter-clockwise seen from outside. */
inline std::vector<Triangle> box_triangles()
{
  return {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
}

inline std::vector<Vec3> icosahedron_points()
{
  const float g = float(std::numbers::phi);
  return {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
          {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
}

inline std::vector<Triangle> icosahedron_triangles()
{
  return {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
}

struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/* The icosahedron on the unit sphere, whose triangles are cut into four `level` times. */
inline Soup icosphere(int level)
{
  Soup soup{icosahedron_points(), icosahedron_triangles()};
  const auto on_sphere = [](const Vector &v) { return rounded(array_of(v.normalized())); };
  for (Vec3 &v : soup.vertices) v = on_sphere(vector_of(v));
  for (; level > 0; --level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), uint32_t(soup.vertices.size()));
      if (fresh) soup.vertices.push_back(on_sphere(vector_of(soup.vertices[a]) + vector_of(soup.vertices[b])));
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto &[a, b, c] : soup.triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle &t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) finer.push_back(t);
    }
    soup.triangles = finer;
  }
  return soup;
}

inline std::vector<Vec3> sphere_points(size_t count, uint64_t seed)
{
  Random random(seed);
  std::vector<Vec3> points;
  while (points.size() < count) {
    const Vector v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (v.norm() > 1 || v.norm() < 0.1) continue;
    const Vector unit = v.normalized();
    points.push_back(rounded(array_of(unit)));
  }
  return points;
}

/* A cylinder of radius 1 and height 2 along Y. */
inline std::vector<Vec3> prism_points(int sides)
{
  std::vector<Vec3> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (float y : {-1.0f, 1.0f}) points.push_back({float(std::cos(angle)), y, float(std::sin(angle))});
  }
  return points;
}

inline Eigen::Quaterniond random_rotation(Random &random)
{
  const std::array<float, 4> q = random.orientation();
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized();
}

inline std::vector<Vec3> moved(const std::vector<Vec3> &points, const Eigen::Quaterniond &rotation,
                               const Vector &offset)
{
  std::vector<Vec3> result;
  for (const Vec3 &p : points) {
    const Eigen::Vector3d v = rotation * Eigen::Vector3d(p[0], p[1], p[2]);
    result.push_back(rounded(array_of(Vector(v.x(), v.y(), v.z()) + offset)));
  }
  return result;
}

template <class Action> std::string complaint(const Action &action)
{
  try {
    action();
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

} // namespace tandem::geometry_test
