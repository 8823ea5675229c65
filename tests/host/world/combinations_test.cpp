/* What parts of a world do together: bodies that sleep, properties that change, snapshots and going back. Each alone is
 * tested beside its own source. */
#include <algorithm>
#include <limits>

#include <tandem/world.h>

#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Body 0 is a floor; the others are dynamic. */
Scene floor_with(const std::vector<Body> &bodies)
{
  Scene scene;
  scene.name = "floor";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f), box_shape(3, 3, 3),
                  sphere_shape(0.05f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  scene.bodies.insert(scene.bodies.end(), bodies.begin(), bodies.end());
  return scene;
}

void wait_for_sleep(World &world, uint32_t bodies)
{
  for (int k = 0; k < 300 && world.statistics().asleep < bodies; ++k) world.step();
  REQUIRE(world.statistics().asleep == bodies);
}

} // namespace

/* The half-space is the last body of the scene and the first in the buffers, so no index there is that of the scene. */
TEST_CASE("a new mass is that of the body it was given to, wherever the body lies in the buffers", "[sanitizer]")
{
  Scene scene = floor_with({});
  scene.bodies = {body_at({0, 5, 0}, 2), body_at({3, 5, 0}, 2), body_at({6, 5, 0}, 2), scene.bodies[0]};
  scene.gravity = {0, 0, 0};
  for (uint32_t heavy = 0; heavy < 3; ++heavy) {
    World world(scene, {}, {"serial", {}});
    world.set_mass(world.id_of(heavy), 4);
    for (uint32_t body = 0; body < 3; ++body) world.add_impulse(world.id_of(body), {{1, 0, 0}});
    world.step();
    for (uint32_t body = 0; body < 3; ++body)
      CHECK(world.read_body(world.id_of(body)).linear_velocity[0] == (body == heavy ? 0.25f : 1.0f));
  }
}

/* Sleepers that are all large have no cells. */
TEST_CASE("a small ball about the origin finds a large box that sleeps alone", "[sanitizer]")
{
  std::vector<Body> bodies{body_at({2.95, 3, 0}, 3)};
  for (int k = 0; k < 8; ++k) bodies.push_back(body_at({-20.0 - k, 2000, 0}, 4)); /* they make the median small */
  World world(floor_with(bodies), sleepy(), {"serial", {}});
  wait_for_sleep(world, 1);
  Body ball = body_at({-1, 4, 0}, 4);
  ball.gravity_factor = 0;
  ball.linear_velocity = {2, 0, 0};
  world.create_body(ball);
  int awake_after = 0;
  for (; awake_after < 60 && world.is_asleep(world.id_of(1)); ++awake_after) world.step();
  CHECK(awake_after > 25); /* 0.9 m at 2 m/s take 27 steps */
  CHECK(awake_after < 30);
}

TEST_CASE("a half-space that moves far below sleepers leaves them asleep", "[sanitizer]")
{
  Body lower = body_at({0, -50, 0}, 0);
  lower.type = BodyType::kinematic;
  World world(floor_with({body_at({0, 0.5, 0}, 1), lower}), sleepy(), {"serial", {}});
  wait_for_sleep(world, 1);
  world.set_velocity(world.id_of(2), {{0, 1, 0}, {0, 0, 0}});
  for (int k = 0; k < 5; ++k) world.step();
  CHECK(world.is_asleep(world.id_of(1)));
}

TEST_CASE("a fixed body that is quarantined does not put the world to rest", "[sanitizer]")
{
  Body fixed = body_at({50, 0.5, 0}, 1);
  fixed.type = BodyType::fixed;
  Scene scene = floor_with({body_at({0, 500, 0}, 1), fixed});
  World world(scene, sleepy(), {"serial", {}});
  BodyState state = world.bodies()[2];
  state.position[0] = std::numeric_limits<double>::quiet_NaN();
  world.set_body_unchecked(2, state);
  for (int k = 0; k < 60; ++k) world.step();
  REQUIRE(world.quarantined().size() == 1);
  CHECK(world.bodies()[1].position[1] == Approx(500 + 0.5 * scene.gravity[1]).margin(0.01));
}

TEST_CASE("handles of shapes go with the bodies that going back takes away", "[sanitizer]")
{
  World world(floor_with({body_at({0, 0.5, 0}, 1)}), {}, {"serial", {}});
  world.create_body(body_at({5, 5, 5}, 2)); /* makes room for others */
  world.keep_states(2);
  const ShapeId shape = world.shapes_of(world.create_body(body_at({9, 9, 9}, 2))).front();
  world.go_back(0);
  CHECK_THROWS_WITH(world.body_of(shape), ContainsSubstring("there is no shape"));
  const World same(world.save(), {"serial", {}});
  CHECK(same.body_count() == 3);
}

TEST_CASE("a body that going back revives has the handles of shapes that it had", "[sanitizer]")
{
  World world(floor_with({body_at({0, 0.5, 0}, 1), body_at({5, 5, 5}, 2)}), {}, {"serial", {}});
  const ShapeId shape = world.shapes_of(world.id_of(2)).front();
  world.keep_states(2);
  world.destroy_body(world.id_of(2));
  CHECK_THROWS_WITH(world.body_of(shape), ContainsSubstring("does not exist any more"));
  world.go_back(0);
  CHECK(world.body_of(shape).index == 2);
  CHECK(world.shapes_of(world.id_of(2)).front() == shape);
}

namespace {

/* What a program does before a step; the same again after the world has gone back to it. */
void call_before(World &world, uint64_t step)
{
  const std::vector<BodyId> ids = world.body_ids();
  const BodyId any = ids[1 + step * 7 % (ids.size() - 1)];
  if (step % 31 == 30) world.add_impulse(any, {.impulse = {0.3f, 3, 0}});
  if (step % 47 == 46 && ids.size() > 4) world.destroy_body(any);
  if (step % 37 == 36) world.create_body(body_at({static_cast<double>(step % 5), 3, 0}, 2));
  if (step % 53 == 52) world.wake_body(any);
}

} // namespace

TEST_CASE("going back over steps in which bodies fell asleep and woke makes the same steps again", "[sanitizer]")
{
  Settings settings = sleepy();
  settings.sleep_time = 0.1f;
  settings.events = true;
  for (const char *on : {"serial", "tbb:threads=2,lanes=4"}) {
    World world(floor_with({body_at({0, 0.5, 0}, 1), body_at({0, 1.5, 0}, 1), body_at({3, 0.5, 0}, 1),
                            body_at({6, 0.25, 0}, 2), body_at({2, 4, 0}, 2)}),
                settings, {on, {}});
    world.create_body(body_at({9, 9, 0}, 2)); /* makes room for others */
    world.keep_states(30);
    std::vector<uint64_t> hashes;
    std::vector<uint32_t> asleep;
    uint32_t crossed = 0;
    for (uint64_t attempt = 0; hashes.size() < 240; ++attempt) {
      const uint64_t step = world.statistics().steps;
      call_before(world, step);
      world.step();
      const uint64_t hash = world.state_hash();
      const uint32_t sleepers = world.statistics().asleep;
      if (step == hashes.size()) {
        hashes.push_back(hash);
        asleep.push_back(sleepers);
      }
      CAPTURE(on, step, attempt);
      REQUIRE(hash == hashes[step]);
      if (attempt % 13 != 12) continue;
      const uint32_t back = static_cast<uint32_t>(attempt * 5 % 12);
      REQUIRE(back < world.states_kept());
      world.go_back(back);
      if (back == 0) continue;
      REQUIRE(world.state_hash() == hashes[step - back]);
      REQUIRE(world.statistics().asleep == asleep[step - back]);
      crossed += asleep[step - back] != sleepers;
    }
    CHECK(crossed > 3);
  }
}

TEST_CASE("who woke before a snapshot is told by the step after it, once", "[sanitizer]")
{
  World world(floor_with({body_at({0, 0.5, 0}, 1)}), sleepy(), {"serial", {}});
  wait_for_sleep(world, 1);
  world.wake_body(world.id_of(1));
  const std::vector<std::byte> snapshot = world.save();
  World restored(snapshot, {"serial", {}});
  for (World *one : {&world, &restored}) {
    one->step();
    REQUIRE(one->sleep_events().size() == 1);
    CHECK(one->sleep_events().front().body == one->id_of(1));
    CHECK_FALSE(one->sleep_events().front().asleep);
    one->step();
    CHECK(one->sleep_events().empty());
  }
}

/* Else no call could free room, because each call wakes first. */
TEST_CASE("islands wake also where more pairs have come since than a step may have", "[sanitizer]")
{
  Settings few = sleepy();
  few.max_pairs = 3;
  World world(floor_with({body_at({0, 0.5, 0}, 1), body_at({0, 1.5, 0}, 1)}), few, {"serial", {}});
  wait_for_sleep(world, 2);
  world.create_bodies(std::vector<Body>{body_at({9, 0.5, 0}, 1), body_at({9, 1.5, 0}, 1)});
  for (int k = 0; k < 10; ++k) world.step();
  world.wake_body(world.id_of(2));
  CHECK(world.bodies()[2].position[1] == Approx(1.5).margin(0.01));
  world.destroy_body(world.id_of(4));
  for (int k = 0; k < 10; ++k) world.step();
  CHECK(world.bodies()[2].position[1] == Approx(1.5).margin(0.01));
}

/* The trigger passes over the box for four seconds, of which the box would sleep from the first half on. */
TEST_CASE("a trigger that moves over a sleeper wakes it once and lets it sleep when it has passed", "[address]")
{
  Body trigger = body_at({-6, 0.5, 0}, 1);
  trigger.type = BodyType::kinematic;
  trigger.trigger = true;
  Settings settings = sleepy();
  settings.events = true;
  World world(floor_with({body_at({0, 0.5, 0}, 1), trigger}), settings, {"serial", {}});
  wait_for_sleep(world, 1);
  world.set_velocity(world.id_of(2), {{0.5f, 0, 0}, {0, 0, 0}});
  int woke = 0, slept = 0, began = 0, ended = 0;
  for (int k = 0; k < 60 * 20; ++k) {
    world.step();
    for (const SleepEvent &event : world.sleep_events()) ++(event.asleep ? slept : woke);
    for (const ContactEvent &event : world.contact_events()) {
      if (!event.trigger) continue;
      if (event.kind == ContactEvent::Kind::begin) ++began;
      if (event.kind == ContactEvent::Kind::end) ++ended;
    }
  }
  CHECK(woke == 1);
  CHECK(slept == 1);
  CHECK(began == 1);
  CHECK(ended == 1);
}

/* A box is about to fall asleep in one of these steps, and its first speed is below the limit of rest. */
TEST_CASE("gravity that changes in any step moves bodies at rest, also those that are about to sleep", "[address]")
{
  for (int steps = 27; steps < 34; ++steps) {
    World world(floor_with({body_at({0, 0.5, 0}, 1)}), sleepy(), {"serial", {}});
    for (int k = 0; k < steps; ++k) world.step();
    const double start = world.bodies()[1].position[1];
    world.set_gravity({0, 2, 0});
    for (int k = 0; k < 60; ++k) world.step();
    CAPTURE(steps);
    CHECK(world.bodies()[1].position[1] - start == Approx(1).margin(0.03));
  }
}

TEST_CASE("kept states are forgotten when gravity changes, because they have another one", "[sanitizer]")
{
  World world(floor_with({body_at({0, 9, 0}, 1)}), {}, {"serial", {}});
  world.keep_states(3);
  world.step();
  world.set_gravity({0, 1, 0});
  CHECK_THROWS_WITH(world.go_back(1), ContainsSubstring("gravity was changed"));
}

/* Bodies come to rest one after another, so that in some steps one falls asleep and the next one is about to. */
TEST_CASE("a snapshot of any step falls asleep in the same steps", "[sanitizer]")
{
  World world(floor_with({body_at({0, 0.5, 0}, 1), body_at({5, 0.26, 0}, 2), body_at({9, 0.27, 0}, 2)}), sleepy(),
              {"serial", {}});
  for (int k = 0; k < 60; ++k) {
    World other(world.save(), {"serial", {}});
    world.step();
    other.step();
    CAPTURE(k);
    CHECK(other.state_hash() == world.state_hash());
  }
  CHECK(world.statistics().asleep == 3);
}

TEST_CASE("a world in which the shape of a destroyed body was used again can be saved", "[sanitizer]")
{
  World world(floor_with({body_at({0, 0.5, 0}, 1), body_at({5, 0.5, 0}, 1)}), {}, {"serial", {}});
  Child child;
  child.shape = sphere_shape(0.3f);
  child.position = {0, 0.5f, 0};
  world.add_shape_to(world.id_of(1), child);
  world.destroy_body(world.id_of(1));
  world.step();
  child.position = {0.4f, 0.4f, 0.2f};
  world.add_shape_to(world.id_of(2), child);
  World other(world.save(), {"serial", {}});
  CHECK(other.state_hash() == world.state_hash());
}

/* Two balls whose boxes overlap and that do not touch are a pair of two islands. */
TEST_CASE("nothing of a sleeping body that is destroyed stays with a sleeper beside it", "[sanitizer]")
{
  Settings settings = sleepy();
  settings.pair_events = true;
  for (const uint32_t doomed : {1u, 2u}) {
    World world(floor_with({body_at({0, 0.25, 0}, 2), body_at({0.45, 0.25, 0.45}, 2)}), settings, {"serial", {}});
    wait_for_sleep(world, 2);
    REQUIRE(world.statistics().sleeping_islands == 2);
    world.destroy_body(world.id_of(doomed));
    world.step();
    CAPTURE(doomed);
    const std::vector<PairEvent> events = world.pair_events();
    CHECK(std::count_if(events.begin(), events.end(), [](const PairEvent &event) {
            return event.kind == ContactEvent::Kind::end && event.a == 1 && event.b == 2;
          }) == 1);
  }
}
