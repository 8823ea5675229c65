/* Resting contact: stacks stand and piles do not sink, also far from the origin. */
#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A column of unit cubes on a static block with its top at the origin, all moved by `offset`. */
Scene column(int height, const Vec3 &offset)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(5, 1, 5), {offset[0], offset[1] - 1, offset[2]});
  for (int i = 0; i < height; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f),
             {offset[0], offset[1] + 0.5f + float(i), offset[2]});
  return scene;
}

/* Two logs of 2 m a layer, each layer across the one below. half: of the side of a log, m. */
Scene log_cabin(int layers, float half)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int layer = 0; layer < layers; ++layer)
    for (double side : {-0.3, 0.3}) {
      const bool across = layer % 2;
      Body &log = add_body(scene, BodyType::dynamic, box_shape(1, half, half),
                           {across ? side : 0, half * (1 + 2.002 * layer), across ? 0 : side});
      log.orientation = turn_about(Vector::UnitY(), across ? pi / 2 : 0);
    }
  return scene;
}

double farthest_drift(const std::vector<BodyState> &from, const std::vector<BodyState> &to, bool sideways_only)
{
  double worst = 0;
  for (size_t i = 0; i < from.size(); ++i) {
    Vector moved = vector_of(to[i].position) - vector_of(from[i].position);
    if (sideways_only) moved.y() = 0;
    worst = std::max(worst, moved.norm());
  }
  return worst;
}

} // namespace

TEST_CASE("a stack of ten boxes stands a thousand steps", "[physics]")
{
  const bool on_half_space = GENERATE(false, true);
  const Scene scene = on_half_space ? load_scene("box-stack:n=10,height=10") : column(10, {0, 0, 0});
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  run(world, 100);
  const std::vector<BodyState> settled = world.bodies();
  const double sunk = farthest_drift(start, settled, false);
  double deepest = 0;
  for (int i = 0; i < 9; ++i) {
    run(world, 100);
    deepest = std::max(deepest, world.statistics().max_penetration);
  }
  const double sideways = farthest_drift(start, world.bodies(), true),
               drift = farthest_drift(settled, world.bodies(), false);
  INFO("ten boxes, 1000 steps: settle " << sunk << " m in 100 steps, then drift " << drift << " m; sideways "
                                        << sideways << " m; deepest contact " << deepest);
  CHECK(sideways < 0.001);
  CHECK(drift < 0.001);
  CHECK(deepest < 0.005);
}

TEST_CASE("a grid of boxes sinks less than two centimetres", "[physics]")
{
  World world(load_scene("box-grid:nx=8,ny=8,nz=8"));
  double deepest = 0;
  for (int i = 0; i < 12; ++i) {
    run(world, 10);
    deepest = std::max(deepest, world.statistics().max_penetration);
  }
  const Statistics statistics = world.statistics();
  INFO("box-grid 8 x 8 x 8: maximum penetration " << statistics.max_penetration << " m at step 120, " << deepest
                                                  << " at any tenth step; mean " << statistics.mean_penetration);
  CHECK(statistics.max_penetration < 0.02);
  CHECK(deepest < 0.02);
  CHECK(statistics.contacts > 3000);
}

/* Floats are 2 mm apart there. */
TEST_CASE("a stack stands 20 km from the origin", "[physics]")
{
  const Vec3 offset = GENERATE(Vec3{20000, 0, 0}, Vec3{-20000, 0, 20000}, Vec3{0, 20000, 0});
  World world(column(5, offset));
  const std::vector<BodyState> start = world.bodies();
  double deepest = 0;
  for (int i = 0; i < 60; ++i) {
    run(world, 10);
    deepest = std::max(deepest, world.statistics().max_penetration);
  }
  const double drift = farthest_drift(start, world.bodies(), false);
  INFO("at (" << offset[0] << ", " << offset[1] << ", " << offset[2] << "): five boxes, 600 steps: moved " << drift
              << " m, deepest contact " << deepest);
  CHECK(drift < 0.004);
  CHECK(deepest < 0.004);
}

/* Thin logs bend at their crossings by angles so small that the axis of two edges leads by more than their
 * thickness. */
TEST_CASE("a cabin of long thin logs stands", "[physics]")
{
  const float half = GENERATE(0.02f, 0.05f, 0.1f);
  World world(log_cabin(8, half));
  run(world, 120);
  CAPTURE(half);
  CHECK(world.statistics().max_penetration < 0.2 * double{half});
}

TEST_CASE("cubes that fall in a heap sink no deeper than two of the fastest close within a step, and not for long",
          "[physics]")
{
  Scene scene = load_scene("falling-boxes:n=600");
  const bool as_hulls = GENERATE(false, true);
  for (Shape &shape : scene.shapes)
    if (as_hulls && shape.type == ShapeType::box) shape = hull_of_box(shape.size[0], shape.size[1], shape.size[2]);
  World world(scene);
  double fastest = 0;
  for (int i = 0; i < 300; ++i) {
    for (const BodyState &body : world.bodies()) fastest = std::max(fastest, vector_of(body.linear_velocity).norm());
    world.step();
    /* Contacts are found once a step: what comes nearer without one is stopped in the next. */
    REQUIRE(world.statistics().max_penetration <= 2 * fastest * world.settings().step);
  }
  CHECK(world.statistics().max_penetration < 0.1 * 0.5); /* what is parted slowly (DEEP_SHARE of a half extent) */
}
