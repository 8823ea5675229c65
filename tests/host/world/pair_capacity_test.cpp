/* Room for pairs can be reserved and given back, and neither changes a bit. */
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <tandem/error.h>
#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/memory.h"
#include "shared/counts.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/parity/parity.h"

namespace tandem {
namespace {

using Catch::Matchers::ContainsSubstring;

/* Balls around one point, which burst apart: 4,950 pairs at first, and none in the end. */
Scene burst(uint32_t balls)
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  Random random(7);
  for (uint32_t i = 0; i < balls; ++i) {
    Body ball;
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    ball.position = {0.01 * x, 0.01 * y, 0.01 * z};
    ball.linear_velocity = {float(60 * x), float(60 * y), float(60 * z)};
    scene.bodies.push_back(ball);
  }
  return scene;
}

constexpr uint32_t balls = 100, all_pairs = balls * (balls - 1) / 2;
constexpr int steps = 40;

std::vector<std::string> backends()
{
  std::vector<std::string> names{"serial", "tbb"};
  parity::add_pocl(names);
  return names;
}

uint64_t hash_after(World &world, int count)
{
  for (int i = 0; i < count; ++i) world.step();
  return world.state_hash();
}

TEST_CASE("a step for whose pairs room was reserved does not run again, and has the same bits")
{
  for (const std::string &name : backends()) {
    World plain(burst(balls), {}, {name, {}}), ready(burst(balls), {}, {name, {}});
    ready.reserve_pairs(all_pairs);
    CHECK(hash_after(plain, 1) == hash_after(ready, 1));
    CHECK(plain.statistics().pairs == all_pairs);
    CHECK(plain.statistics().overflow > 0);
    CHECK(ready.statistics().overflow == 0);
  }
}

/* A device gives a launch as many work-groups as it expects items, and one if it expects none. */
TEST_CASE("launches over kinds of pairs and over colours expect items before a step has counted any, and after growth")
{
  Settings settings;
  settings.broadphase = Broadphase::grid;
  World world(load_scene("shapes:n=12"), settings, {"serial", {}});
  uint32_t ranges = 0, without = 0;
  world.set_observer([&](const Launch &launch) {
    const bool of_kind = launch.first >= KIND_START && launch.first < KIND_START + uint32_t{PAIR_KIND_NONE},
               of_color = launch.first >= COLOR_START && launch.first < COLOR_START + COLOR_LIMIT;
    if (!of_kind && !of_color) return;
    ++ranges;
    without += launch.expected == 0 ||
               launch.expected > world.memory().read<uint32_t>(Buffer::counts, 1, CAPACITY_PAIRS).front();
  });
  world.step();
  CHECK(ranges > 10);
  CHECK(without == 0);
  Scene mixed = parity::imploding_boxes();
  mixed.shapes.push_back(sphere_shape(0.3f));
  for (size_t body = 0; body < mixed.bodies.size(); body += 5)
    if (mixed.bodies[body].type == BodyType::dynamic) mixed.bodies[body].shape = uint32_t(mixed.shapes.size()) - 1;
  World growing(mixed, settings, {"serial", {}});
  bool has_grown = false;
  uint32_t of_boxes = 0;
  growing.set_observer([&](const Launch &launch) {
    if (launch.kernel == Kernel::collide_box_box) of_boxes = launch.expected;
  });
  for (int step = 0; step < 20 && !has_grown; ++step) {
    growing.step();
    has_grown = growing.statistics().overflow > 0;
  }
  REQUIRE(has_grown);
  CHECK(of_boxes > 0);
}

TEST_CASE("the first step that outgrows its room makes hardly more than it needs, and each later one an eighth more")
{
  Settings settings;
  settings.broadphase = Broadphase::grid; /* finds all pairs, whatever there is room for */
  World world(parity::imploding_boxes(), settings);
  const auto room_of = [&] { return world.memory().read<uint32_t>(Buffer::counts, 1, CAPACITY_PAIRS).front(); };
  uint32_t room = room_of(), grown = 0;
  for (int i = 0; i < 20; ++i) {
    world.step();
    if (room_of() == std::exchange(room, room_of())) continue;
    const uint32_t pairs = world.statistics().pairs;
    CHECK(room == pairs + pairs / (grown++ == 0 ? 64 : 8));
  }
  CHECK(grown >= 2);
}

TEST_CASE("a step that fails after it outgrew its room does not count as the first that did")
{
  Settings settings;
  settings.broadphase = Broadphase::grid;
  World world(burst(balls), settings, {"serial", {}});
  const auto room_of = [&] { return world.memory().read<uint32_t>(Buffer::counts, 1, CAPACITY_PAIRS).front(); };
  CHECK_THROWS_AS(world.step({.rounds = 1}), LimitExceeded);
  world.step();
  const uint32_t room = room_of();
  REQUIRE(room == all_pairs + all_pairs / 64);
  world.create_bodies(burst(balls).bodies);
  REQUIRE(room_of() == room);
  world.step();
  const uint32_t pairs = world.statistics().pairs;
  REQUIRE(pairs > room);
  CHECK(room_of() == pairs + pairs / 64);
}

TEST_CASE("bodies that cannot be pushed have no room for pairs of their own")
{
  Scene few = burst(600), many = few;
  few.bodies.resize(1);
  for (size_t i = 1; i < many.bodies.size(); ++i) many.bodies[i].type = BodyType::fixed;
  World pushed(burst(600), {}, {"serial", {}}), alone(few, {}, {"serial", {}}), beside(many, {}, {"serial", {}});
  const auto room = [](World &world) { return world.memory().bytes(Buffer::pair_b) / sizeof(uint32_t); };
  CHECK(room(pushed) == 1200);
  CHECK(room(beside) == room(alone));
}

TEST_CASE("room that is reserved between steps keeps the cache of contacts")
{
  World plain(burst(balls)), other(burst(balls));
  CHECK(hash_after(plain, 5) == hash_after(other, 5));
  other.reserve_pairs(3 * all_pairs);
  CHECK(other.state_hash() == plain.state_hash());
  CHECK(hash_after(plain, 5) == hash_after(other, 5));
}

TEST_CASE("room that is given back frees most of the memory, and the world goes on with the same bits")
{
  Settings settings;
  settings.events = true;
  for (const std::string &name : backends()) {
    World plain(burst(balls), settings, {name, {}}), other(burst(balls), settings, {name, {}});
    CHECK(hash_after(plain, steps) == hash_after(other, steps));
    REQUIRE(plain.statistics().pairs < all_pairs / 10);
    const size_t before = other.memory().total_bytes();
    other.shrink_to_fit();
    CHECK(other.memory().total_bytes() < before / 2);
    CHECK(other.contact_events().empty());
    CHECK(other.statistics().contacts == 0);
    CHECK(other.state_hash() == plain.state_hash());
    CHECK(hash_after(plain, 10) == hash_after(other, 10));
  }
}

TEST_CASE("states that were kept fit into a world that gave room back")
{
  World world(burst(balls));
  world.keep_states(3, false);
  world.step();
  const uint64_t early = world.state_hash();
  world.keep_state();
  hash_after(world, steps);
  world.shrink_to_fit();
  world.go_back(0);
  CHECK(world.state_hash() == early);
  const uint64_t again = hash_after(world, 3);
  World other(burst(balls));
  CHECK(hash_after(other, 4) == again);
}

TEST_CASE("no more room can be reserved than the settings allow")
{
  Settings settings;
  settings.max_pairs = 5000;
  World world(burst(balls), settings);
  CHECK_THROWS_WITH(world.reserve_pairs(5001), ContainsSubstring("5001 pairs; 5000 are the most"));
  world.reserve_pairs(5000);
  hash_after(world, 1);
  CHECK(world.statistics().pairs == all_pairs);
}

/* The sorted order of bodies that queries traverse lies in buffers that are laid out anew. */
TEST_CASE("queries find the same after room for pairs was reserved and given back")
{
  for (const Broadphase broadphase : {Broadphase::grid, Broadphase::trees, Broadphase::sap}) {
    Settings settings;
    settings.broadphase = broadphase;
    World world(burst(balls), settings);
    hash_after(world, 20);
    std::vector<Ray> rays;
    Random random(3);
    for (int i = 0; i < 200; ++i)
      rays.push_back({.origin = {random.uniform(-9, 9), random.uniform(-9, 9), -30},
                      .direction = {0, 0, 1},
                      .reach = 60,
                      .filter = {}});
    const auto bodies_hit = [&] {
      std::vector<uint32_t> bodies;
      for (const RayHit &hit : world.cast_rays(rays)) bodies.push_back(hit.body);
      return bodies;
    };
    const std::vector<uint32_t> before = bodies_hit();
    CHECK(std::count(before.begin(), before.end(), no_body) < 190);
    world.reserve_pairs(4 * all_pairs);
    CHECK(bodies_hit() == before);
    world.shrink_to_fit();
    CHECK(bodies_hit() == before);
  }
}

} // namespace
} // namespace tandem
