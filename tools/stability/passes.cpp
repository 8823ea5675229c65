/* passes.cpp - builds the obstacles, movers and lanes; see passes.h. */
#include "tools/stability/passes.h"

#include <algorithm>
#include <cmath>

#include "host/geometry/convex_hull.h"

namespace tandem::stability {
namespace {

constexpr double step = 1.0 / 60, lane_width = 20;

Shape octahedron_shape()
{
  const std::vector<Vec3> points{{0.06f, 0, 0},  {-0.06f, 0, 0}, {0, 0.04f, 0},
                                 {0, -0.04f, 0}, {0, 0, 0.05f},  {0, 0, -0.05f}};
  return hull_shape(points, "octahedron");
}

/* A roof of two slopes, with its ridge along z at the top. */
Shape roof_shape()
{
  const float half = 0.5f;
  const std::vector<Vec3> vertices{{0, 0, -half},        {0, 0, half},         {-half, -half, -half},
                                   {-half, -half, half}, {half, -half, -half}, {half, -half, half}};
  const std::vector<uint32_t> triangles{0, 2, 1, 1, 2, 3, 0, 1, 4, 1, 5, 4};
  return mesh_shape(vertices, triangles, "roof");
}

Shape sheet_shape()
{
  const std::vector<Vec3> vertices{{0, -2, -2}, {0, -2, 2}, {0, 2, -2}, {0, 2, 2}};
  const std::vector<uint32_t> triangles{0, 1, 2, 2, 1, 3};
  return mesh_shape(vertices, triangles, "sheet");
}

/* A cube of 1 m, rotated so that its highest point is above the lane's origin, at y = 0. */
void add_cube_below(Scene &scene, const Quat &turn, const Vector &corner, double z)
{
  const Vector top = axes_of(turn) * corner;
  add_body(scene, BodyType::fixed, box_shape(0.5f, 0.5f, 0.5f), {-top.x(), -top.y(), z - top.z()}).orientation = turn;
}

/* A bar that rotates freely at 100 rad/s, with one of its tips at the top at the time `passes`. */
void add_rotor(Scene &scene, double z, double passes)
{
  const float half = 0.5f, thick = 0.02f;
  const double spin = 100, tip = std::atan2(double(thick), double(half));
  Body &rotor = add_body(scene, BodyType::dynamic, box_shape(half, thick, 0.05f),
                         {0, -std::hypot(double(half), double(thick)), z});
  rotor.orientation = turn_about({0, 0, 1}, std::remainder(pi / 2 - tip - spin * passes, 2 * pi));
  rotor.angular_velocity = {0, 0, float(spin)};
}

void add_obstacle(Scene &scene, Obstacle obstacle, double z, double passes)
{
  switch (obstacle) {
  case Obstacle::edge: return add_cube_below(scene, turn_about({0, 0, 1}, pi / 4), {0.5, 0.5, 0}, z);
  case Obstacle::corner:
    return add_cube_below(scene, turn_about(Vector(1, 1, 1).cross(Vector(0, 1, 0)), std::acos(1 / std::sqrt(3.0))),
                          {0.5, 0.5, 0.5}, z);
  case Obstacle::mesh_edge: add_body(scene, BodyType::fixed, roof_shape(), {0, 0, z}); return;
  case Obstacle::rotor: return add_rotor(scene, z, passes);
  }
}

/* At least two whole steps and 30 cm before the lane's origin, plus a fraction of a step that differs between lanes, so
 * that contacts are found at all distances. */
double time_to_pass(double speed, size_t row)
{
  const size_t lane = row * all_speeds().size() +
                      size_t(std::find(all_speeds().begin(), all_speeds().end(), speed) - all_speeds().begin());
  const double part = std::fmod(0.13 + 0.29 * double(lane), 1.0);
  return step * (std::max(2.0, std::ceil(0.3 / (speed * step))) + part);
}

void add_mover(Scene &scene, const Mover &mover, const Vector &lowest, double speed)
{
  const Vector centre = lowest - lowest_point(mover);
  Body &body = add_body(scene, BodyType::dynamic, mover.shape, point_of(centre));
  body.orientation = mover.orientation;
  body.linear_velocity = {float(speed), 0, 0};
}

} // namespace

const std::vector<double> &all_speeds()
{
  static const std::vector<double> values{1, 5, 30, 100, 300};
  return values;
}

const std::vector<Mover> &movers()
{
  const Quat skew = turn_about({1, 2, 3}, 0.7);
  static const std::vector<Mover> all{{"ball", sphere_shape(0.05f), {0, 0, 0, 1}},
                                      {"box", box_shape(0.05f, 0.04f, 0.06f), skew},
                                      {"capsule", capsule_shape(0.03f, 0.05f), skew},
                                      {"hull", octahedron_shape(), skew}};
  return all;
}

Vector lowest_point(const Mover &mover)
{
  const Matrix axes = axes_of(mover.orientation);
  const Vec3 &size = mover.shape.size;
  const auto down = [&](int k) -> Vector { return (axes(1, k) > 0 ? -1.0 : 1.0) * axes.col(k); };
  if (mover.shape.type == ShapeType::sphere) return {0, -double(size[0]), 0};
  if (mover.shape.type == ShapeType::capsule) return double(size[1]) * down(1) - Vector(0, double(size[0]), 0);
  if (mover.shape.type == ShapeType::box)
    return double(size[0]) * down(0) + double(size[1]) * down(1) + double(size[2]) * down(2);
  Vector lowest(0, HUGE_VAL, 0);
  for (const Vec3 &vertex : mover.shape.hull->vertices)
    if (const Vector at = axes * vector_of(vertex); at.y() < lowest.y()) lowest = at;
  return lowest;
}

Passes passes_of(const Mover &mover, Obstacle obstacle, const std::vector<double> &clearances,
                 const std::vector<double> &speeds)
{
  Passes passes{empty_scene({0, 0, 0}), {}};
  for (size_t row = 0; row < clearances.size(); ++row)
    for (double speed : speeds) {
      const double clearance = clearances[row], z = lane_width * (double(passes.lanes.size()) - 7),
                   when = time_to_pass(speed, row);
      const size_t body = passes.scene.bodies.size();
      add_obstacle(passes.scene, obstacle, z, when);
      add_mover(passes.scene, mover, {-speed * when, clearance, z}, speed);
      passes.lanes.push_back({clearance, speed, when, body, body + 1});
    }
  return passes;
}

Passes hits_on_wall(const Mover &mover, bool mesh, const std::vector<double> &speeds)
{
  Passes passes{empty_scene({0, 0, 0}), {}};
  for (double speed : speeds) {
    const double z = lane_width * (double(passes.lanes.size()) - 2), when = time_to_pass(speed, 0);
    const size_t body = passes.scene.bodies.size();
    add_body(passes.scene, BodyType::fixed, mesh ? sheet_shape() : box_shape(0.005f, 2, 2), {0, 0, z});
    add_mover(passes.scene, mover, {-speed * when, 0, z}, speed);
    passes.lanes.push_back({0, speed, when, body, body + 1});
  }
  return passes;
}

} // namespace tandem::stability
