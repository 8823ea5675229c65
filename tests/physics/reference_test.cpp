/* The reference backend: the same kernels in double, checked against closed forms and its own order of convergence
 * before anything is measured against it. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement in_double{"reference", {}, false};

/* A tumbling brick after half a second. */
std::array<double, 4> tumbled(uint32_t substeps)
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.5f, 0.9f), {0, 0, 0}).angular_velocity = {3, 5, 2};
  World world(scene, settings_with(1.0 / 64, substeps), in_double);
  run(world, 32);
  return world.precise_bodies()[0].orientation;
}

double distance(const std::array<double, 4> &p, const std::array<double, 4> &q)
{
  return std::sqrt(std::pow(p[0] - q[0], 2) + std::pow(p[1] - q[1], 2) + std::pow(p[2] - q[2], 2) +
                   std::pow(p[3] - q[3], 2));
}

/* Twenty boxes fall into a heap; mean height. */
Scene small_heap()
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < 20; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.4f, 0.3f),
             {0.13f * float(i % 5), 1 + 0.9f * float(i), 0.1f * float(i % 3)});
  return scene;
}

} // namespace

TEST_CASE("reference: a projectile follows the parabola to the rounding of doubles", "[physics][reference]")
{
  Scene scene = empty_scene({0.5f, -10, 0.25f});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.2f, 0.3f), {20, 5, 0}).linear_velocity = {3, 12, -4};
  World world(scene, settings_with(1.0 / 60, 4), in_double);
  const int steps = 240;
  run(world, steps);
  const double t = steps * double(world.settings().step);
  const Vector expected = Vector(20, 5, 0) + t * Vector(3, 12, -4) + 0.5 * t * t * Vector(0.5, -10, 0.25);
  CHECK((vector_of(world.precise_bodies()[0].position) - expected).norm() < 1e-12);
}

TEST_CASE("reference: free spin converges with the second order of its integrator", "[physics][reference]")
{
  const auto finest = tumbled(512);
  const double coarse = distance(tumbled(4), finest), fine = distance(tumbled(8), finest),
               finer = distance(tumbled(16), finest);
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.1));
  CHECK(std::log2(fine / finer) == Approx(2).margin(0.1));
  CHECK(finer > 1e-9); /* or the slopes say nothing */
}

TEST_CASE("reference: spin about a principal axis turns by its angle to the rounding of doubles",
          "[physics][reference]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.5f, 0.9f), {0, 0, 0}).angular_velocity = {0, 0, 2};
  World world(scene, settings_with(1.0 / 64, 1), in_double);
  run(world, 64);
  const auto q = world.precise_bodies()[0].orientation;
  CHECK(std::abs(q[2] - std::sin(1.0)) < 1e-13);
  CHECK(std::abs(q[3] - std::cos(1.0)) < 1e-13);
}

TEST_CASE("reference: any single stage runs in double inside a float step", "[physics][reference]")
{
  const std::string stage = GENERATE("broadphase", "narrowphase", "batching", "setup", "solve", "integrate");
  const Broadphase broadphase = GENERATE(Broadphase::grid, Broadphase::sap);
  Settings settings;
  settings.broadphase = broadphase;
  World world(small_heap(), settings, Placement{"serial", {{stage, "reference"}}, false});
  World plain(small_heap(), settings, Placement{"serial", {}, false});
  run(world, 3); /* before the first contact grows the rounding */
  run(plain, 3);
  CHECK(world.statistics().pairs == plain.statistics().pairs);
  for (size_t i = 0; i < plain.bodies().size(); ++i)
    CHECK((physics_tests::vector_of(world.bodies()[i].position) - physics_tests::vector_of(plain.bodies()[i].position))
              .norm() < 1e-5);
}

TEST_CASE("reference: threads do not change its results", "[physics][reference]")
{
  World one(small_heap(), Settings{}, Placement{"reference:threads=1", {}, false});
  World many(small_heap(), Settings{}, Placement{"reference:threads=7", {}, false});
  run(one, 60);
  run(many, 60);
  CHECK(one.state_hash() == many.state_hash());
  for (size_t i = 0; i < 20; ++i) CHECK(one.precise_bodies()[i].position == many.precise_bodies()[i].position);
}
