/* shapes.cpp - the scenes of shapes.h: convex hulls, all shapes in a pile, rolling, and continuous collision
 * detection. */
#include "host/catalog/shapes.h"

#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/base/trigonometry.h"
#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* Sets the mass to that of a ball of this radius at 1,000 kg / m^3, and the centre of mass and axes to those of the
 * shape. */
void finish_stone(Scene &scene, Body &body, double radius)
{
  body.mass = round_to_float(1000 * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius);
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
    const uint32_t shape =
        random.below(kinds_of_stone); /* drawn first, because the order of evaluation of arguments is unspecified */
    Body &body = add_body(scene, shape, grid.place(i, jitter, random));
    body.orientation = random.orientation();
    finish_stone(scene, body, 0.35);
  }
  return scene;
}

/* --- shapes: every kind in one pile ------------------------------------------------------------------- */

Scene shapes(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.shapes = {sphere_shape(0.35f),         box_shape(0.4f, 0.25f, 0.3f),
                  capsule_shape(0.2f, 0.3f),   Shape{ShapeType::capsule, {0.3f, 0.25f, 0.15f}},
                  cylinder_shape(0.3f, 0.35f), cylinder_shape(0.45f, 0.08f),
                  cone_shape(0.4f, 0.35f),     Shape{ShapeType::cylinder, {0.4f, 0.2f, 0.2f}}};
  for (int k = 0; k < 4; ++k) scene.shapes.push_back(stone(12 + 12 * k, random));
  const auto movable = uint32_t(scene.shapes.size());
  const double radius = 0.6, jitter = 0.05;
  CellGrid grid{cube_side(whole(v, "n")), 2 * (radius + jitter), radius + jitter};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(grid.side) + 0.5);
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    Body &body = add_body(scene, uint32_t(i) % movable, grid.place(i, jitter, random));
    body.orientation = random.orientation();
    finish_stone(scene, body, 0.35);
  }
  return scene;
}

/* --- rolling: down a ramp, each in a lane of its own ------------------------------------------------------ */

Scene rolling(const SceneValues &v)
{
  const double angle = number(v, "angle") * 3.14159265358979 / 180;
  const auto [sine, cosine] = sine_cosine(angle);
  const SineCosine half = sine_cosine(0.5 * angle);
  Scene scene;
  Body &ramp = add_body(scene, add_shape(scene, half_space_shape()));
  ramp.name = "ramp";
  ramp.type = BodyType::fixed;
  ramp.orientation = {0, 0, round_to_float(-half.sine), round_to_float(half.cosine)};
  const Shape round[] = {sphere_shape(0.3f), cylinder_shape(0.3f, 0.4f), cylinder_shape(0.3f, 0.05f),
                         capsule_shape(0.3f, 0.4f)};
  const char *names[] = {"ball", "cylinder", "disc", "capsule"};
  for (size_t k = 0; k < 4; ++k) {
    Body &body = add_body(scene, add_shape(scene, round[k]), {0.3 * sine, 0.3 * cosine, 2.0 * double(k)}, 10);
    body.name = names[k];
    if (k > 0) body.orientation = {0.70710678f, 0, 0, 0.70710678f}; /* axis across the ramp */
    take_mass_properties(scene, body);
  }
  return scene;
}

/* --- thin-wall: small solids of every kind, shot at a sheet ------------------------------------------------------- */

constexpr double wall_side = 200; /* half the edge of the sheet, m */

Scene thin_wall(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.gravity = {0, 0, 0};
  Body &wall = add_body(scene, add_shape(scene, box_shape(round_to_float(number(v, "thickness") / 2),
                                                          round_to_float(wall_side), round_to_float(wall_side))));
  wall.name = "wall";
  wall.type = BodyType::fixed;
  const auto first = uint32_t(scene.shapes.size());
  for (const Shape &shape : {sphere_shape(0.02f), box_shape(0.03f, 0.02f, 0.01f), capsule_shape(0.01f, 0.03f),
                             cylinder_shape(0.015f, 0.03f), Shape{ShapeType::cylinder, {0.02f, 0.03f, 0}}})
    scene.shapes.push_back(shape);
  std::vector<Vec3> points;
  for (int k = 0; k < 16; ++k) {
    const Vec3 at = direction(random);
    points.push_back({0.03f * at[0], 0.02f * at[1], 0.025f * at[2]});
  }
  scene.shapes.push_back(hull_shape(points, "stone"));
  const auto kinds = uint32_t(scene.shapes.size()) - first;
  const int64_t side = cube_side(whole(v, "n")) * 2;
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    const Point place{-0.2 - random.uniform(0, 2), 0.2 * double(i % side - side / 2),
                      0.2 * double(i / side - side / 2)};
    Body &body = add_body(scene, first + uint32_t(i) % kinds, place);
    const SineCosine lean = sine_cosine(random.uniform(0, number(v, "angle")) * 3.14159265358979 / 180);
    const SineCosine about = sine_cosine(random.uniform(0, 6.2831853));
    const double speed = number(v, "speed"), spin = random.uniform(0, number(v, "spin"));
    const Vec3 axis = direction(random);
    body.linear_velocity = {round_to_float(speed * lean.cosine), round_to_float(speed * lean.sine * about.cosine),
                            round_to_float(speed * lean.sine * about.sine)};
    body.angular_velocity = {round_to_float(spin * axis[0]), round_to_float(spin * axis[1]),
                             round_to_float(spin * axis[2])};
    body.orientation = random.orientation();
    body.continuous = true;
    body.filter_group = 2;
    body.filter_mask = 1; /* the wall alone */
    finish_stone(scene, body, 0.02);
  }
  return scene;
}

/* --- bullet-stack: a bullet into boxes that stand before a sheet --- */

Scene bullet_stack(const SceneValues &v)
{
  Scene scene;
  add_ground(scene);
  const float half = 0.1f, radius = 0.01f;
  const int64_t height = whole(v, "height"), rows = whole(v, "rows");
  Body &wall =
      add_body(scene, add_shape(scene, box_shape(round_to_float(number(v, "thickness") / 2), 2, 2)), {0, 2, 0});
  wall.name = "wall";
  wall.type = BodyType::fixed;
  const uint32_t box = add_shape(scene, box_shape(half, half, half));
  for (int64_t row = 0; row < rows; ++row)
    for (int64_t level = 0; level < height; ++level)
      add_body(scene, box, {-0.5 - 2.2 * double(half) * double(row), double(half) * double(2 * level + 1), 0}, 2);
  const double aim = double(half) * double(height); /* between two boxes, or at the middle of one */
  Body &bullet = add_body(scene, add_shape(scene, sphere_shape(radius)),
                          {-2 - 2.2 * double(half) * double(rows), aim, 0.01}, 0.05f);
  bullet.name = "bullet";
  bullet.continuous = true;
  bullet.linear_velocity = {round_to_float(number(v, "speed")), 0, 0};
  return scene;
}

} // namespace

std::vector<BuiltInScene> shape_scenes()
{
  const double most = double(most_bodies - 5);
  const auto walled = [](const SceneValues &v) { return 5 + uint64_t(whole(v, "n")); };
  return {
      {"convex-hulls",
       "random convex hulls that fall into a yard",
       {{"n", integer, 1000, 1, most, "hulls"},
        {"points", integer, 32, 4, 1000, "vertices of a hull"},
        seed_parameter()},
       walled,
       convex_hulls},
      {"shapes",
       "every convex shape in one pile",
       {{"n", integer, 200, 1, most, "bodies"}, seed_parameter()},
       walled,
       shapes},
      {"thin-wall",
       "small solids of every kind are shot at a sheet; none passes it",
       {{"n", integer, 100, 1, most, "solids"},
        {"speed", real, 1000, 0, 10000, "m/s"},
        {"thickness", real, 0.002, 0.0001, 0.1, "of the sheet, m"},
        {"angle", real, 70, 0, 85, "to its normal at most, degrees"},
        {"spin", real, 200, 0, 10000, "at most, rad/s"},
        seed_parameter()},
       [](const SceneValues &v) { return 1 + uint64_t(whole(v, "n")); },
       thin_wall},
      {"bullet-stack",
       "a bullet hits stacks of boxes that stand before a sheet",
       {{"speed", real, 1000, 0, 10000, "m/s"},
        {"height", integer, 5, 1, 15, "boxes of a stack"},
        {"rows", integer, 3, 1, 1000, "stacks"},
        {"thickness", real, 0.002, 0.0001, 0.1, "of the sheet, m"}},
       [](const SceneValues &v) { return 3 + uint64_t(whole(v, "height") * whole(v, "rows")); },
       bullet_stack},
      {"rolling",
       "a ball, two cylinders and a capsule roll down a ramp",
       {{"angle", real, 10, 0, 60, "of the ramp, degrees"}},
       [](const SceneValues &) { return uint64_t{5}; },
       rolling},
  };
}

} // namespace tandem
