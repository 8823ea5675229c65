/* builders.h - what the builders of the catalogue (catalog.h) share: typed parameters, and functions that add bodies to
 * a scene. */
#pragma once

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"

namespace tandem::scene_builders {

inline constexpr auto integer = SceneParameter::Type::integer;
inline constexpr auto real = SceneParameter::Type::real;

inline constexpr double density_of_water = 1000; /* kg/m^3 */

inline int64_t whole(const SceneValues &values, const char *name) { return int64_t(values.find(name)->second); }
inline double number(const SceneValues &values, const char *name) { return values.find(name)->second; }

/* The number of bodies of scenes that consist of a ground and `n` bodies. */
inline uint64_t ground_and_n(const SceneValues &values) { return 1 + uint64_t(whole(values, "n")); }

inline uint32_t add_shape(Scene &scene, const Shape &shape)
{
  scene.shapes.push_back(shape);
  return uint32_t(scene.shapes.size() - 1);
}

/* Other fields of the body are set on the reference, before the next body is added. */
inline Body &add_body(Scene &scene, uint32_t shape, const Point &position = {0, 0, 0}, float mass = 1)
{
  Body body;
  body.shape = shape;
  body.position = position;
  body.mass = mass;
  scene.bodies.push_back(body);
  return scene.bodies.back();
}

/* The ground is a half-space: all points with y <= 0. */
inline Body &add_ground(Scene &scene)
{
  Body &ground = add_body(scene, add_shape(scene, half_space_shape()));
  ground.name = "ground";
  ground.type = BodyType::fixed;
  return ground;
}

/* The smallest side of a cube of cells that holds n. */
inline int64_t cube_side(int64_t n)
{
  int64_t side = 1;
  while (side * side * side < n) ++side;
  return side;
}

/* Places `count` items in layers of side × side cells, centred over the origin, with the centres of the lowest cells
 * at y = bottom. Items whose radius plus jitter is below cell / 2 cannot touch. */
struct CellGrid {
  int64_t side;
  double cell, bottom;

  Point place(int64_t index, double jitter, Random &random) const
  {
    int64_t layer = index / (side * side), within = index % (side * side);
    double x = (double(within % side) - 0.5 * double(side - 1)) * cell;
    double z = (double(within / side) - 0.5 * double(side - 1)) * cell;
    double dx = random.uniform(-jitter, jitter), dy = random.uniform(-jitter, jitter),
           dz = random.uniform(-jitter, jitter);
    return {round_to_float(x + dx), round_to_float(bottom + double(layer) * cell + dy), round_to_float(z + dz)};
  }
};

/* Four static boxes around |x|, |z| <= inner, with a height of a third of the yard's width. */
inline void add_walls(Scene &scene, double inner)
{
  float half_height = round_to_float(inner / 3), thick = 0.5f, far = round_to_float(inner) + thick;
  auto first = uint32_t(scene.shapes.size());
  scene.shapes.push_back(box_shape(thick, half_height, round_to_float(inner) + 2 * thick));
  scene.shapes.push_back(box_shape(round_to_float(inner) + 2 * thick, half_height, thick));
  for (int side = 0; side < 4; ++side) {
    Body &wall = add_body(scene, first + (side >= 2), {0, half_height, 0});
    wall.name = "wall";
    wall.type = BodyType::fixed;
    wall.position[side < 2 ? 0 : 2] = side % 2 ? far : -far;
  }
}

/* A random point of the unit sphere. */
inline Vec3 direction(Random &random)
{
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1),
                 length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length < 1)
      return {round_to_float(x / length), round_to_float(y / length), round_to_float(z / length)};
  }
}

/* A stone: the convex hull of random points of an ellipsoid with half axes of 0.25 to 0.5 m. */
inline Shape stone(int64_t points, Random &random)
{
  const Vec3 size{round_to_float(random.uniform(0.25, 0.5)), round_to_float(random.uniform(0.25, 0.5)),
                  round_to_float(random.uniform(0.25, 0.5))};
  std::vector<Vec3> cloud;
  for (int64_t i = 0; i < points; ++i) {
    const Vec3 at = direction(random);
    cloud.push_back({at[0] * size[0], at[1] * size[1], at[2] * size[2]});
  }
  return hull_shape(cloud, "stone");
}

inline SceneParameter seed_parameter() { return {"seed", integer, 1, 0, 4294967295.0, "start of the random numbers"}; }
inline SceneParameter half_extent_parameter()
{
  return {"half_extent", real, 0.5, 0.001, 1000, "half the edge of a box, m"};
}

} // namespace tandem::scene_builders
