/* Worlds whose broadphase is `auto`: what is chosen on either side of each threshold, and that a change of it, whatever
 * leads to it, shows in no bit. */
#include <set>
#include <tuple>

#include <tandem/compare.h>
#include <tandem/shapes.h>
#include <tandem/world.h>

#include "host/pipeline/broadphases/choice.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

/* A floor, and spheres beside each other, which come to rest on it at once. */
Body sphere_at(uint32_t place, double height = 0.4)
{
  Body body;
  body.shape = 1;
  body.position = {0.81 * (place % 12), height, 0.81 * (place / 12)};
  return body;
}

Scene spheres_on_floor(uint32_t spheres, double height = 0.4)
{
  Scene scene;
  scene.name = "spheres on a floor";
  scene.shapes = {half_space_shape(), sphere_shape(0.4f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  for (uint32_t k = 0; k < spheres; ++k) scene.bodies.push_back(sphere_at(k, height));
  return scene;
}

Settings with(Broadphase broadphase, bool sleeping = false)
{
  Settings settings;
  settings.broadphase = broadphase;
  settings.sleeping = sleeping;
  settings.sleep_time = 0.1f;
  return settings;
}

std::vector<BodyId> add_spheres(World &world, uint32_t first, uint32_t count)
{
  std::vector<Body> bodies;
  for (uint32_t k = first; k < first + count; ++k) bodies.push_back(sphere_at(k, 0.6));
  return world.create_bodies(bodies);
}

/* Steps both and compares them; returns what the first one ran. */
Broadphase step_both(World &chosen, World &asked, int steps)
{
  for (int k = 0; k < steps; ++k) {
    chosen.step();
    asked.step();
    REQUIRE(chosen.state_hash() == asked.state_hash());
  }
  return chosen.settings().broadphase;
}

Broadphase chosen_for(size_t bodies, const char *backend, std::optional<Broadphase> before = {}, bool moving = false)
{
  return choose_broadphase(spheres_on_floor(3), bodies, backend, {before, moving}).broadphase;
}

std::vector<std::string> with_pocl()
{
  std::vector<std::string> backends = {"serial", "tbb:threads=2"};
  parity::add_pocl(backends);
  return backends;
}

/* What a backend takes for many bodies that rest. */
Broadphase for_many(const std::string &backend)
{
  return backend.starts_with("cl") ? Broadphase::grid : Broadphase::trees;
}

} // namespace

TEST_CASE("auto takes brute force for few bodies, and lets it go and come back at different numbers")
{
  for (const auto &[backend, few, many] : {std::tuple{"serial", size_t{64}, Broadphase::trees},
                                           {"tbb:threads=2", size_t{64}, Broadphase::trees},
                                           {"cl:nvidia", size_t{128}, Broadphase::grid}}) {
    CAPTURE(backend);
    CHECK(chosen_for(few, backend) == Broadphase::brute_force);
    CHECK(chosen_for(few + 1, backend) == many);
    CHECK(chosen_for(few, backend, Broadphase::brute_force) == Broadphase::brute_force);
    CHECK(chosen_for(few / 2 + 1, backend, many) == many);
    CHECK(chosen_for(few / 2, backend, many) == Broadphase::brute_force);
    for (const size_t bodies : {few / 2, few / 2 + 1, few, few + 1})
      for (const Broadphase before : {Broadphase::brute_force, many}) {
        CAPTURE(bodies, before);
        CHECK(is_still_right(before, bodies, backend) == (chosen_for(bodies, backend, before) == before));
      }
  }
  CHECK(chosen_for(1000, "tbb", Broadphase::trees, true) == Broadphase::grid);
  CHECK(chosen_for(64, "tbb", Broadphase::brute_force, true) == Broadphase::brute_force);
}

TEST_CASE("auto goes by the backend that runs the stage broadphase")
{
  CHECK(broadphase_backend({"tbb", {}}) == "tbb");
  CHECK(broadphase_backend({"tbb", {{"solve", "cl"}, {"broadphase", "serial"}}}) == "serial");
  Placement as_for_another{"tbb", {{"broadphase", "serial"}}};
  as_for_another.broadphase_for = "cl";
  CHECK(broadphase_backend(as_for_another) == "cl");
}

TEST_CASE("trees rest while most bodies leave their places, and each time longer")
{
  TreesTrial trial;
  const auto rebuilds_every = [&](uint32_t interval, uint32_t steps, double pairs_of_body = 1) {
    uint32_t with_trees = 0;
    for (uint32_t k = 0; k < steps; ++k) {
      const bool trees = !trial.pauses();
      trial.note_step(trees, trees && k % interval == 0, pairs_of_body);
      with_trees += trees;
    }
    return with_trees;
  };
  CHECK(rebuilds_every(TreesTrial::quiet + 1, 1000) == 1000);
  CHECK(rebuilds_every(10, 10000) < 500);
  CHECK(trial.pauses());
  for (uint32_t k = 0; k < TreesTrial::longest_pause; ++k) trial.note_step(false, false, 1);
  CHECK_FALSE(trial.pauses());
  CHECK(rebuilds_every(100000, 1000) == 1000);
  rebuilds_every(1, 2); /* long quiet has made the next pause short again */
  CHECK(trial.pauses());
  for (uint32_t k = 0; k < TreesTrial::first_pause; ++k) trial.note_step(false, false, 1);
  CHECK_FALSE(trial.pauses());
  CHECK(rebuilds_every(1, 1000, 6.1) == 1000); /* a grid is worse where bodies crowd */
  rebuilds_every(1, 2);
  REQUIRE(trial.pauses());
  trial.note_step(false, false, 6.5); /* a number that varies a little does not change the broadphase in turns */
  CHECK(trial.pauses());
  trial.note_step(false, false, 7.5);
  CHECK_FALSE(trial.pauses());
}

TEST_CASE("auto is the default, and a world of few bodies has no buffer of a grid")
{
  CHECK(Settings{}.broadphase == Broadphase::automatic);
  World few(spheres_on_floor(20), {}), grid(spheres_on_floor(20), with(Broadphase::grid)),
      many(spheres_on_floor(64), {});
  CHECK(few.settings().broadphase == Broadphase::brute_force);
  CHECK_THAT(few.broadphase_why(), ContainsSubstring("21 bodies; up to 64"));
  CHECK(few.memory().bytes(Buffer::cell_start) == 0);
  CHECK(grid.memory().bytes(Buffer::cell_start) > 0);
  CHECK(grid.broadphase_why() == "as asked");
  CHECK(few.memory().total_bytes() < grid.memory().total_bytes());
  CHECK(many.settings().broadphase == Broadphase::trees);
  few.step();
  CHECK(few.memory().bytes(Buffer::cell_start) == 0);
}

TEST_CASE("a world that grows past a threshold and shrinks again keeps its bits")
{
  for (const std::string &backend : with_pocl())
    for (const bool sleeping : {false, true}) {
      CAPTURE(backend, sleeping);
      World chosen(spheres_on_floor(20), with(Broadphase::automatic, sleeping), {backend, {}}),
          asked(spheres_on_floor(20), with(Broadphase::sap, sleeping), {backend, {}});
      CHECK(step_both(chosen, asked, 4) == Broadphase::brute_force);
      add_spheres(chosen, 20, 140);
      add_spheres(asked, 20, 140);
      CHECK(step_both(chosen, asked, 4) == for_many(backend));
      for (World *world : {&chosen, &asked})
        for (uint32_t body = 1; body <= 150; ++body) world->destroy_body(world->id_of(body));
      CHECK(step_both(chosen, asked, 4) != Broadphase::brute_force); /* kernels still pass over the free places */
      add_spheres(chosen, 40, 30);
      add_spheres(asked, 40, 30);
      step_both(chosen, asked, 4);
    }
}

TEST_CASE("a world most of which falls asleep takes brute force for the rest, and lets it go when all wake")
{
  for (const std::string &backend : with_pocl()) {
    CAPTURE(backend);
    const Scene scene = spheres_on_floor(200);
    World chosen(scene, with(Broadphase::automatic, true), {backend, {}}),
        asked(scene, with(Broadphase::grid, true), {backend, {}});
    CHECK(step_both(chosen, asked, 2) == for_many(backend));
    int steps = 0;
    while (asked.statistics().asleep < 190 && ++steps < 200) step_both(chosen, asked, 1);
    REQUIRE(asked.statistics().asleep >= 190);
    const std::vector<BodyId> one = add_spheres(chosen, 201, 1), other = add_spheres(asked, 201, 1);
    chosen.add_impulse(one[0], {{1, 2, 0}});
    asked.add_impulse(other[0], {{1, 2, 0}});
    CHECK(step_both(chosen, asked, 2) == Broadphase::brute_force);
    const Ray down{{0.1, 5, 0.1}, {0, -9, 0}, 1, {}};
    CHECK(chosen.cast_rays(std::vector<Ray>{down})[0].body == asked.cast_rays(std::vector<Ray>{down})[0].body);
    for (World *world : {&chosen, &asked})
      for (uint32_t body = 1; body <= 200; ++body) world->wake_body(world->id_of(body));
    CHECK(step_both(chosen, asked, 3) == for_many(backend));
  }
}

TEST_CASE("a snapshot keeps the wish, and is restored on either side of a threshold with the same bits")
{
  for (const std::string &backend : with_pocl()) {
    CAPTURE(backend);
    World few(spheres_on_floor(100), {}, {backend, {}}),
        asked(spheres_on_floor(100), with(Broadphase::grid), {backend, {}});
    step_both(few, asked, 3);
    const std::vector<std::byte> of_few = few.save();
    add_spheres(few, 100, 100);
    few.step();
    CHECK(few.settings().broadphase == for_many(backend));
    few.restore(of_few);
    CHECK(few.settings().broadphase == (backend.starts_with("cl") ? Broadphase::brute_force : Broadphase::trees));
    CHECK(few.save() == of_few);
    step_both(few, asked, 3);
    for (const std::string &other : with_pocl()) {
      CAPTURE(other);
      World elsewhere(of_few, {other, {}}), expected(of_few, {"serial", {{"broadphase", "serial"}}});
      CHECK(elsewhere.settings().broadphase == (other.starts_with("cl") ? Broadphase::brute_force : Broadphase::trees));
      step_both(elsewhere, expected, 3);
    }
  }
}

TEST_CASE("going back past a threshold leads to the same steps")
{
  for (const std::string &backend : with_pocl()) {
    CAPTURE(backend);
    World world(spheres_on_floor(200), with(Broadphase::automatic, true), {backend, {}});
    world.keep_states(100, true);
    std::vector<uint64_t> hashes;
    std::vector<Broadphase> ran;
    for (int step = 0; step < 60; ++step) {
      world.step();
      hashes.push_back(world.state_hash());
      ran.push_back(world.settings().broadphase);
    }
    REQUIRE(std::set<Broadphase>(ran.begin(), ran.end()).contains(for_many(backend)));
    REQUIRE(world.statistics().asleep > 190);
    world.go_back(58);
    for (int step = 2; step < 60; ++step) {
      world.step();
      CAPTURE(step);
      REQUIRE(world.state_hash() == hashes[static_cast<size_t>(step)]);
    }
  }
}

TEST_CASE("bodies that fall far leave the trees, and find them again at rest, with the bits of the grid")
{
  const Scene scene = spheres_on_floor(150, 60);
  World chosen(scene, {}, {"tbb", {}}), asked(scene, with(Broadphase::grid), {"tbb", {}});
  CHECK(chosen.settings().broadphase == Broadphase::trees);
  int steps = 0;
  while (chosen.settings().broadphase == Broadphase::trees && ++steps < 100) step_both(chosen, asked, 1);
  CHECK(chosen.settings().broadphase == Broadphase::grid);
  CHECK_THAT(chosen.broadphase_why(), ContainsSubstring("keep moving"));
  step_both(chosen, asked, 260); /* all lie on the floor */
  for (steps = 0; chosen.settings().broadphase == Broadphase::grid && steps < 2000; ++steps)
    step_both(chosen, asked, 1);
  CHECK(step_both(chosen, asked, 200) == Broadphase::trees);
}

TEST_CASE("backends that would choose differently are compared with one choice")
{
  parity::require_pocl();
  ComparisonRequest request;
  request.backends = {"serial", "cl:pocl"};
  request.steps = 4;
  const Comparison as_cpu = compare_backends(spheres_on_floor(100), request);
  CHECK(as_cpu.equal);
  CHECK(as_cpu.broadphase == Broadphase::trees);
  request.backends = {"cl:pocl", "serial"};
  const Comparison as_device = compare_backends(spheres_on_floor(100), request);
  CHECK(as_device.equal);
  CHECK(as_device.broadphase == Broadphase::brute_force);
  const std::vector<std::byte> snapshot = World(spheres_on_floor(100), {}, {"serial", {}}).save();
  request.snapshot = snapshot;
  CHECK(compare_backends(spheres_on_floor(100), request).broadphase == Broadphase::brute_force);
}

TEST_CASE("auto: queries after a change of placement find what they found before it")
{
  Scene scene;
  scene.shapes = {half_space_shape(), sphere_shape(0.4f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  for (int k = 0; k < 99; ++k) {
    Body body;
    body.shape = 1;
    body.position = {0.81 * (k % 12), 0.4, 0.81 * (k / 12)};
    scene.bodies.push_back(body);
  }
  Placement as_for_a_device{"serial", {}, false};
  as_for_a_device.broadphase_for = "cl";
  World world(scene, {}, as_for_a_device);
  world.step();
  REQUIRE(world.settings().broadphase == Broadphase::brute_force);
  const std::vector<Ray> down = {{{0.1, 5, 0.1}, {0, -9, 0}, 1, {}}};
  const auto before = world.cast_rays(down).at(0);
  REQUIRE(before.body == 1);
  world.place({"serial", {}, false});
  const auto after = world.cast_rays(down).at(0);
  CHECK(after.body == before.body);
  CHECK(after.fraction == before.fraction);
}
