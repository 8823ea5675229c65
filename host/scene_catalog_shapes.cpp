/* scene_catalog_shapes.cpp - see scene_catalog_shapes.h. */
#include "host/scene_catalog_shapes.h"

#include <cmath>
#include <fmt/format.h>

#include "host/scene_builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* Mass from 1,000 kg / m^3 of a ball of that radius, centre and axes from the shape. */
void finish(Scene &scene, Body &body, double radius)
{
  body.mass = float(1000 * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius);
  take_mass_properties(scene, body);
}

/* --- convex-hulls ---------------------------------------------------------------------------------- */

constexpr uint32_t kinds_of_stone = 16;

Scene convex_hulls(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  for (uint32_t k = 0; k < kinds_of_stone; ++k) scene.shapes.push_back(stone(whole(v, "points"), random));
  const double radius = 0.5, jitter = 0.05;
  CellGrid grid{cube_side(whole(v, "n")), 2 * (radius + jitter), radius + jitter};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(grid.side) + 0.5);
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    Body &body = add_body(scene, random.below(kinds_of_stone), grid.place(i, jitter, random));
    body.orientation = random.orientation();
    finish(scene, body, 0.35);
  }
  return scene;
}

/* --- shapes: every kind in one pile ------------------------------------------------------------------- */

Scene shapes(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.shapes = {sphere_shape(0.35f),         box_shape(0.4f, 0.25f, 0.3f), capsule_shape(0.2f, 0.3f), Shape{ShapeType::capsule, {0.3f, 0.25f, 0.15f}},
                  cylinder_shape(0.3f, 0.35f), cylinder_shape(0.45f, 0.08f), cone_shape(0.4f, 0.35f),   Shape{ShapeType::cylinder, {0.4f, 0.2f, 0.2f}}};
  for (int k = 0; k < 4; ++k) scene.shapes.push_back(stone(12 + 12 * k, random));
  const auto movable = uint32_t(scene.shapes.size());
  const double radius = 0.6, jitter = 0.05;
  CellGrid grid{cube_side(whole(v, "n")), 2 * (radius + jitter), radius + jitter};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(grid.side) + 0.5);
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    Body &body = add_body(scene, uint32_t(i) % movable, grid.place(i, jitter, random));
    body.orientation = random.orientation();
    finish(scene, body, 0.35);
  }
  return scene;
}

/* --- rolling: down a ramp, each in a lane of its own ------------------------------------------------------ */

Scene rolling(const SceneValues &v)
{
  const double angle = number(v, "angle") * 3.14159265358979 / 180, sine = std::sin(angle), cosine = std::cos(angle);
  Scene scene;
  Body &ramp = add_body(scene, add_shape(scene, half_space_shape()));
  ramp.name = "ramp";
  ramp.motion = Motion::fixed;
  ramp.orientation = {0, 0, float(std::sin(-angle / 2)), float(std::cos(-angle / 2))};
  const Shape round[] = {sphere_shape(0.3f), cylinder_shape(0.3f, 0.4f), cylinder_shape(0.3f, 0.05f), capsule_shape(0.3f, 0.4f)};
  const char *names[] = {"ball", "cylinder", "disc", "capsule"};
  for (size_t k = 0; k < 4; ++k) {
    Body &body = add_body(scene, add_shape(scene, round[k]), {0.3 * sine, 0.3 * cosine, 2.0 * double(k)}, 10);
    body.name = names[k];
    if (k > 0) body.orientation = {0.70710678f, 0, 0, 0.70710678f}; /* axis across the ramp */
    take_mass_properties(scene, body);
  }
  return scene;
}

} // namespace

std::vector<BuiltInScene> shape_scenes()
{
  const double most = double(most_bodies - 5);
  const auto walled = [](const SceneValues &v) { return 5 + uint64_t(whole(v, "n")); };
  return {
      {"convex-hulls", "random convex hulls that fall into a yard", {{"n", integer, 1000, 1, most, "hulls"}, {"points", integer, 32, 4, 1000, "vertices of a hull"}, seed_parameter()},
       walled, convex_hulls},
      {"shapes", "every convex shape in one pile", {{"n", integer, 200, 1, most, "bodies"}, seed_parameter()}, walled, shapes},
      {"rolling", "a ball, two cylinders and a capsule roll down a ramp", {{"angle", real, 10, 0, 60, "of the ramp, degrees"}}, [](const SceneValues &) { return uint64_t{5}; }, rolling},
  };
}

} // namespace tandem
