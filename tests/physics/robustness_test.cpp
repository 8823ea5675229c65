/* Nothing is lost or silent: a body that is not finite is named and taken out, and buffers that overflow grow. */
#include <limits>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

uint64_t hash_after_poisoning(const std::string &backend, const BodyState &poison)
{
  Scene scene = load_scene("box-grid:nx=3,ny=3,nz=3");
  scene.bodies[14].name = "middle";
  World world(scene, {}, Placement{backend, {}, false});
  run(world, 10);
  world.set_body_unchecked(14, poison);
  run(world, 20);
  REQUIRE(world.quarantined().size() == 1);
  const Quarantine found = world.quarantined().front();
  CHECK(found.body == 14);
  CHECK(found.name == "middle");
  CHECK(found.stage == "start");
  CHECK(found.step == 10);
  CHECK(world.statistics().nonfinite == 1);
  CHECK(world.statistics().steps == 30);
  CHECK(all_finite(world.bodies()));
  CHECK(std::isfinite(world.statistics().kinetic_energy));
  CHECK(world.bodies()[14].linear_velocity == Vec3{0, 0, 0});
  for (size_t i = 1; i < scene.bodies.size(); ++i) {
    if (i != 14) CHECK(world.bodies()[i].position[1] > 0.9f);
  }
  return world.state_hash();
}

/* n bodies of one shape in one place, over a ground. */
Scene dense_cluster(const Shape &shape, int n)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < n; ++i) add_body(scene, BodyType::dynamic, shape, {0, 0.5f, 0});
  return scene;
}

} // namespace

TEST_CASE("a body that is not finite is named and quarantined, and the rest go on", "[physics][address]")
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  BodyState poison{{0, 5, 0}, {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
  SECTION("NaN position") { poison.position[1] = nan; }
  SECTION("infinite position") { poison.position[0] = -infinity; }
  SECTION("NaN orientation") { poison.orientation[3] = nan; }
  SECTION("infinite velocity") { poison.linear_velocity[2] = infinity; }
  SECTION("positions without bounds that fit a grid") { poison.position = {0, 1.8e38f, nan}; }
  SECTION("velocities without such bounds") { poison.linear_velocity = {0, infinity, nan}; }
  SECTION("NaN spin") { poison.angular_velocity[0] = nan; }
  CHECK(hash_after_poisoning("serial", poison) == hash_after_poisoning("tbb", poison));
}

TEST_CASE("several bodies that are not finite are quarantined in one step", "[physics]")
{
  World world(load_scene("spheres:n=30"));
  BodyState poison = world.bodies()[3];
  poison.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  for (uint32_t body : {3u, 7u, 20u}) world.set_body_unchecked(body, poison);
  world.step();
  CHECK(world.quarantined().size() == 3);
  CHECK(world.statistics().steps == 1);
  run(world, 60);
  CHECK(world.quarantined().size() == 3);
  CHECK(all_finite(world.bodies()));
}

/* One body is taken out by a repetition of the step: as many of them are run as there are such bodies. */
TEST_CASE("a hundred bodies that are not finite are quarantined in one step, and innocent ones are kept", "[physics]")
{
  World world(load_scene("spheres:n=200"));
  BodyState poison = world.bodies()[3];
  poison.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  for (uint32_t body = 1; body < 200; body += 2) world.set_body_unchecked(body, poison);
  world.step();
  CHECK(world.quarantined().size() == 100);
  for (const Quarantine &taken : world.quarantined()) CHECK(taken.body % 2 == 1);
  CHECK(world.statistics().steps == 1);
  CHECK(all_finite(world.bodies()));
}

/* Each alone, so that all of them leave the range of floats by themselves, in the same step. */
TEST_CASE("thousands of bodies that stop being finite are taken out in few repetitions", "[physics]")
{
  Scene scene = empty_scene({0, 3e38f, 0});
  for (int i = 0; i < 3000; ++i)
    add_dynamic_body(scene, sphere_shape(0.5f), {1000.0 * i, 0, 0}).linear_velocity[1] = 3.4e38f;
  add_dynamic_body(scene, sphere_shape(0.5f), {-1000, 0, 0}).gravity_factor = 0;
  World world(scene);
  int repetitions = 0;
  world.set_observer([&](const Launch &launch) { repetitions += launch.kernel == Kernel::begin_step; });
  world.step();
  CHECK(world.quarantined().size() == 3000);
  for (const Quarantine &taken : world.quarantined()) CHECK(taken.body < 3000);
  CHECK(repetitions < 40);
  CHECK(all_finite(world.bodies()));
}

TEST_CASE("a step that asks for another repetition for ever ends with a line, and leaves the state as it was",
          "[physics]")
{
  World world(load_scene("spheres:n=20"));
  world.step();
  const uint64_t before = world.state_hash();
  int repetitions = 0;
  world.set_observer([&](const Launch &launch) {
    if (launch.kernel != Kernel::finish_step) return;
    ++repetitions;
    const uint32_t more_colors = STATUS_COLORS;
    world.memory().upload(Buffer::counts, &more_colors, sizeof more_colors, COUNT_STATUS * sizeof more_colors);
  });
  CHECK_THROWS_WITH(world.step(), ContainsSubstring("step 1: it did not complete in 96 repetitions"));
  CHECK(repetitions == 96);
  CHECK(world.state_hash() == before);
  world.set_observer({});
  world.step();
  CHECK(world.statistics().steps == 2);
}

TEST_CASE("a body that is not finite is named in a step that also overflows", "[physics][address]")
{
  World world(dense_cluster(sphere_shape(0.4f), 200));
  BodyState poison = world.bodies()[50];
  poison.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  world.set_body_unchecked(50, poison);
  world.step();
  CHECK(world.statistics().overflow > 0);
  REQUIRE(world.quarantined().size() == 1);
  CHECK(world.quarantined().front().body == 50);
  CHECK(all_finite(world.bodies()));
}

TEST_CASE("a speed that overflows in a step is caught before it is committed", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 2, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {5, 2, 0}).linear_velocity = {3e38f, 0, 0};
  World world(scene, settings_with(0.1));
  run(world, 60);
  REQUIRE(world.quarantined().size() == 1);
  CHECK(world.quarantined().front().body == 2);
  CHECK(all_finite(world.bodies()));
  CHECK(world.bodies()[1].position[1] == Approx(0.5).margin(0.01));
}

TEST_CASE("overflow grows the buffers, repeats the step and loses no contact", "[physics]")
{
  const Shape shape = GENERATE(sphere_shape(0.4f), box_shape(0.4f, 0.3f, 0.2f));
  const uint32_t n = 200;
  std::vector<uint64_t> hashes;
  for (const Broadphase broadphase : {Broadphase::brute_force, Broadphase::sap, Broadphase::grid}) {
    Settings settings;
    settings.broadphase = broadphase;
    World world(dense_cluster(shape, int(n)), settings);
    world.step();
    const Statistics statistics = world.statistics();
    CHECK(statistics.overflow > 0);
    CHECK(statistics.steps == 1);
    CHECK(statistics.pairs == n * (n - 1) / 2 + n);
    CHECK(statistics.manifolds >= n * (n - 1) / 2);
    CHECK(all_finite(world.bodies()));
    run(world, 2);
    hashes.push_back(world.state_hash());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}
