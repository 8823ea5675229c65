/* broadphase_inputs.cpp - the scenes of broadphase_inputs.h.
 *
 * Bodies are spread evenly over a cube. Its edge is a multiple of the smallest integer whose cube is at least the
 * number of bodies, so that positions do not depend on a library's cube root. Two cubes of sides s and t overlap in
 * n^2 / 2 (s + t)^3 / volume pairs, from which the density follows.
 */
#include "tools/bench/broadphase_inputs.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/settings.h>

#include "host/catalog/builders.h"
#include "host/scene/body_buffers.h"

namespace tandem {
namespace {

using scene_builders::add_body;
using scene_builders::add_shape;
using scene_builders::cube_side;

constexpr double margin = 0.03; /* m: about twice the margin by which the bounds of a slow body exceed it */

/* A cube about the origin. */
struct Region {
  double side;
  Point place(Random &random) const
  {
    const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5), z = random.uniform(-0.5, 0.5);
    return {x * side, y * side, z * side};
  }
};

/* In a regular grid, each body would have a cell of this edge. */
Region region_of(uint32_t bodies, double cell) { return {cell * double(cube_side(bodies))}; }

/* Sets a velocity in m/s; a body moves by a sixtieth of it in a step. */
void set_moving(Body &body, Random &random, double across = 1, double up = 1)
{
  body.linear_velocity = {float(random.uniform(-across, across)), float(random.uniform(-up, up)),
                          float(random.uniform(-across, across))};
}

Scene without_gravity()
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  return scene;
}

/* (2 (1 + margin))^3 = 8.74 m^3 around a body contain the centres of 4 others. */
Scene spheres(uint32_t bodies)
{
  Random random(1);
  Scene scene = without_gravity();
  const uint32_t sphere = add_shape(scene, sphere_shape(0.5f));
  const Region region = region_of(bodies, 1.3);
  for (uint32_t i = 0; i < bodies; ++i) set_moving(add_body(scene, sphere, region.place(random)), random);
  return scene;
}

/* The boxes of box-grid on their ground, which is one of the bodies. The jitter is too small to separate layers or to
 * join columns. */
Scene pile(uint32_t bodies)
{
  Random random(2);
  Scene scene = without_gravity();
  add_body(scene, add_shape(scene, box_shape(400, 400, 400)), {0, -400, 0}).type = BodyType::fixed;
  const uint32_t box = add_shape(scene, box_shape(1, 1, 1));
  const auto side = uint32_t(cube_side(bodies - 1));
  for (uint32_t i = 0; i + 1 < bodies; ++i) {
    const uint32_t layer = i / (side * side), x = i % side, z = i / side % side;
    const double shift = layer % 2 == 0 ? 1 : 0;
    Body &body = add_body(
        scene, box, {shift + 2.2 * (double(x) - side / 2), 1 + 2.0 * layer, shift + 2.2 * (double(z) - side / 2)});
    for (int axis : {0, 1, 2}) body.position[axis] += (axis == 1 ? 0.1 : 1) * random.uniform(-0.05, 0.05);
    set_moving(body, random, 0.1, 0.02);
  }
  return scene;
}

/* The small bodies overlap each other occasionally; a tenth of them is within reach of the large one in their
 * middle. */
Scene one_large(uint32_t bodies)
{
  constexpr double share_along_axis = 0.4642; /* its cube is 0.1 */
  Random random(3);
  Scene scene = without_gravity();
  const Region region = region_of(bodies, 2);
  const auto half = float(0.5 * (share_along_axis * region.side - 1 - margin));
  set_moving(add_body(scene, add_shape(scene, box_shape(half, half, half))), random);
  const uint32_t small = add_shape(scene, box_shape(0.5f, 0.5f, 0.5f));
  for (uint32_t i = 1; i < bodies; ++i) set_moving(add_body(scene, small, region.place(random)), random);
  return scene;
}

/* Half extents of 1 cm to 10 m, with equally frequent ratios. The largest bodies make most of the pairs: 8 E((h +
 * h')^3) is 1,280 m^3, and with a sixth of it for every body there are three pairs for each. */
Scene sizes(uint32_t bodies)
{
  constexpr uint32_t steps = 256;
  constexpr double ratio = 1.0273522; /* its 256th power is 1,000 */
  Random random(4);
  Scene scene = without_gravity();
  double half = 0.01;
  for (uint32_t k = 0; k < steps; ++k, half *= ratio)
    add_shape(scene, box_shape(float(half), float(half), float(half)));
  const Region region = region_of(bodies, 6);
  for (uint32_t i = 0; i < bodies; ++i) {
    const uint32_t shape = random.below(steps);
    set_moving(add_body(scene, shape, region.place(random)), random);
  }
  return scene;
}

/* Every hundredth body moves among fixed boxes, which make no pairs with each other. */
Scene standing(uint32_t bodies)
{
  constexpr uint32_t variants = 16;
  Random random(5);
  Scene scene = without_gravity();
  const auto half = [&] { return float(random.uniform(0.25, 0.5)); };
  for (uint32_t k = 0; k < variants; ++k) {
    const float x = half(), y = half(), z = half();
    add_shape(scene, box_shape(x, y, z));
  }
  const Region region = region_of(bodies, 1);
  for (uint32_t i = 0; i < bodies; ++i) {
    const uint32_t shape = random.below(variants);
    Body &body = add_body(scene, shape, region.place(random));
    if (i % 100 == 0) set_moving(body, random);
    else body.type = BodyType::fixed;
  }
  return scene;
}

} // namespace

std::span<const BroadphaseInput> broadphase_inputs()
{
  static constexpr BroadphaseInput inputs[] = {
      {"spheres", "equal spheres at random, the bounds of each overlap those of about 4 others", spheres},
      {"pile", "the boxes of box-grid, touching, on a ground", pile},
      {"one-large", "one large box that moves among many small ones and overlaps a tenth of them", one_large},
      {"sizes", "boxes whose sizes spread over three decades", sizes},
      {"static", "99% of the boxes fixed, 1% moving among them", standing},
  };
  return inputs;
}

std::vector<std::string> broadphase_input_names()
{
  std::vector<std::string> names;
  for (const BroadphaseInput &input : broadphase_inputs()) names.push_back(input.name);
  return names;
}

const BroadphaseInput &broadphase_input_named(const std::string &name)
{
  for (const BroadphaseInput &input : broadphase_inputs())
    if (name == input.name) return input;
  throw InputError(fmt::format("scene '{}' is unknown; use {}", name, fmt::join(broadphase_input_names(), ", ")));
}

MovingBodies::MovingBodies(const BroadphaseInput &input, uint32_t bodies)
    : scene(input.scene(bodies)), special(specialise(scene, Settings{}))
{}

std::vector<float4> MovingBodies::places_at(uint32_t frame) const
{
  const double seconds = frame * double(Settings{}.step);
  std::vector<float4> rows;
  rows.reserve(2 * scene.bodies.size());
  for (uint32_t index : special.order) {
    const Body &body = scene.bodies[index];
    Point at = body.position;
    for (size_t axis = 0; axis < 3; ++axis) at[axis] += seconds * double(body.linear_velocity[axis]);
    const std::array<float4, 2> place = double_float3_of(at);
    rows.insert(rows.end(), place.begin(), place.end());
  }
  return rows;
}

} // namespace tandem
