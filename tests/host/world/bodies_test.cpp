/* Bodies that come and go while a world runs: handles, indices, and worlds that go on as if the others had never been
 * there. */
#include <algorithm>
#include <memory>
#include <set>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

/* A ground, as a half-space or as a large box, and shapes of every kind without bodies. */
Scene empty_yard(bool half_space = true)
{
  Scene scene;
  scene.name = "yard";
  scene.shapes = {half_space ? half_space_shape() : box_shape(50, 1, 50), sphere_shape(0.5f),
                  box_shape(0.5f, 0.5f, 0.5f), capsule_shape(0.3f, 0.5f)};
  Body ground;
  ground.type = BodyType::fixed;
  if (!half_space) ground.position = {0, -1, 0};
  scene.bodies = {ground};
  return scene;
}

Body body_at(const Point &position, uint32_t shape = 1)
{
  Body body;
  body.shape = shape;
  body.position = position;
  return body;
}

} // namespace

TEST_CASE("a body created while a world runs falls as one that was there from the start", "[sanitizer]")
{
  for (const uint32_t shape : {1u, 2u, 3u}) {
    Scene with = empty_yard();
    with.bodies.push_back(body_at({0, 3, 0}, shape));
    World expected(with, {}, {"serial", {}}), world(empty_yard(), {}, {"serial", {}});
    for (int k = 0; k < 10; ++k) world.step();
    const BodyId id = world.create_body(body_at({0, 3, 0}, shape));
    CHECK(id == BodyId{1, 1});
    for (int k = 0; k < 120; ++k) {
      expected.step();
      world.step();
      CAPTURE(shape, k);
      REQUIRE(world.bodies()[1].position == expected.bodies()[1].position);
      REQUIRE(world.bodies()[1].angular_velocity == expected.bodies()[1].angular_velocity);
    }
  }
}

TEST_CASE("a world without bodies takes some, and a destroyed one leaves nothing behind", "[sanitizer]")
{
  Scene scene = empty_yard();
  scene.bodies.clear();
  World world(scene, {}, {"serial", {}});
  world.step();
  Body ground;
  ground.type = BodyType::fixed;
  const BodyId under = world.create_body(ground), ball = world.create_body(body_at({0, 0.5, 0}));
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(world.statistics().contacts == 1);
  CHECK(world.read_body(ball).position[1] == Approx(0.5).margin(0.01));
  world.destroy_body(under);
  CHECK(world.body_count() == 1);
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(world.statistics().pairs == 0);
  CHECK(world.read_body(ball).position[1] == Approx(0.5 - 5.0).margin(0.02)); /* 10 / 2 for a second */
}

TEST_CASE("a stale handle is an error that says so, and changes nothing", "[sanitizer]")
{
  World world(empty_yard(), {}, {"serial", {}});
  const BodyId first = world.create_body(body_at({0, 5, 0})), second = world.create_body(body_at({3, 5, 0}));
  world.destroy_body(first);
  CHECK_FALSE(world.exists(first));
  const uint64_t hash = world.state_hash();
  CHECK_THROWS_WITH(world.destroy_body(first), "destroy_bodies: body 1 of generation 1 does not exist any more; it was "
                                               "destroyed");
  CHECK_THROWS_WITH(world.add_impulse(BodyId{}, {}), ContainsSubstring("there is no body"));
  CHECK_THROWS_WITH(world.read_body(BodyId{77, 1}), ContainsSubstring("there is no body 77"));
  CHECK_THROWS_WITH(world.destroy_bodies(std::vector<BodyId>{second, second}), "destroy_bodies: body 2 is given twice");
  CHECK_THROWS_WITH(world.set_velocities(std::vector<BodyId>{second, first}, std::vector<Velocity>(2)),
                    ContainsSubstring("set_velocities: body 1"));
  CHECK_THROWS_WITH(world.set_body(1, {}), ContainsSubstring("does not exist"));
  CHECK(world.exists(second));
  CHECK(world.state_hash() == hash);
  CHECK(world.create_body(body_at({6, 5, 0})).index == 3); /* 1 waits until a step has ended its events */
  world.step();
  const BodyId again = world.create_body(body_at({9, 5, 0}));
  CHECK(again == BodyId{1, 2});
  CHECK_THROWS_WITH(world.read_body(first), ContainsSubstring("its index now belongs to generation 2"));
}

TEST_CASE("a body that cannot be simulated is refused, and none of its call is created", "[sanitizer]")
{
  World world(empty_yard(), {}, {"serial", {}});
  std::vector<Body> bodies(3, body_at({0, 5, 0}));
  bodies[2].mass = -1;
  CHECK_THROWS_WITH(world.create_bodies(bodies), ContainsSubstring("create_bodies: body 2: mass is -1"));
  bodies[2] = body_at({0, 5, 0}, 9);
  CHECK_THROWS_WITH(world.create_bodies(bodies), ContainsSubstring("shape 9 does not exist"));
  CHECK(world.body_count() == 1);
  CHECK_THROWS_WITH(world.add_shape(sphere_shape(-1)), ContainsSubstring("add_shape: shape 4: radius is -1"));
  const BodyId ball = world.create_body(body_at({0, 5, 0}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(world.add_force(ball, {{0, nan, 0}}), ContainsSubstring("entry 0: force is"));
  CHECK_THROWS_WITH(world.move_to(ball, {}), ContainsSubstring("is not kinematic"));
  CHECK_THROWS_WITH(world.set_states(std::vector<BodyId>{ball}, {}), ContainsSubstring("1 handles and 0 entries"));
}

TEST_CASE("events of a destroyed body end in the next step", "[sanitizer]")
{
  Settings settings;
  settings.events = true;
  settings.pair_events = true;
  World world(empty_yard(), settings, {"serial", {}});
  const BodyId ball = world.create_body(body_at({0, 0.5, 0}));
  for (int k = 0; k < 5; ++k) world.step();
  REQUIRE(world.contact_events().size() == 1);
  CHECK(world.contact_events().front().kind == ContactEvent::Kind::persist);
  world.destroy_body(ball);
  const BodyId other = world.create_body(body_at({5, 0.5, 0}));
  CHECK(other.index != ball.index);
  world.step();
  const std::vector<ContactEvent> events = world.contact_events();
  REQUIRE(events.size() == 2);
  CHECK(events[0].kind == ContactEvent::Kind::end);
  CHECK(events[0].b == ball.index);
  CHECK(events[1].kind == ContactEvent::Kind::begin);
  CHECK(events[1].b == other.index);
  world.step();
  CHECK(world.contact_events().size() == 1);
}

/* New half-spaces and large bodies move the others in the buffers; nobody notices. */
TEST_CASE("bodies inserted before others leave their contacts warm and their events in order", "[sanitizer]")
{
  Settings settings;
  settings.events = true;
  Scene scene = empty_yard();
  for (int k = 0; k < 4; ++k) scene.bodies.push_back(body_at({0, 0.5 + k, 0}, 2));
  World undisturbed(scene, settings, {"serial", {}}), world(scene, settings, {"serial", {}});
  for (int k = 0; k < 30; ++k) undisturbed.step(), world.step();
  Body wall = body_at({0, 0, 100}, 0);
  wall.type = BodyType::fixed;
  wall.orientation = {-0.70710678f, 0, 0, 0.70710678f}; /* faces -z, far away */
  const std::vector<ContactEvent> before = world.contact_events();
  const BodyId far = world.create_body(wall);
  CHECK(far.index == 5);
  const std::vector<ContactEvent> after = world.contact_events();
  REQUIRE(after.size() == before.size());
  for (size_t k = 0; k < after.size(); ++k) CHECK((after[k].a == before[k].a && after[k].b == before[k].b));
  for (int k = 0; k < 60; ++k) {
    undisturbed.step();
    world.step();
    CAPTURE(k);
    for (const ContactEvent &event : world.contact_events()) REQUIRE(event.kind == ContactEvent::Kind::persist);
    for (uint32_t body = 1; body < 5; ++body)
      REQUIRE(world.bodies()[body].position[1] == Approx(undisturbed.bodies()[body].position[1]).margin(1e-4));
  }
}

TEST_CASE("shapes and features that come while a world runs are simulated as if they had been there", "[sanitizer]")
{
  Scene with = empty_yard();
  std::vector<Vec3> corners;
  for (const float x : {-0.5f, 0.5f})
    for (const float y : {-0.5f, 0.5f})
      for (const float z : {-0.5f, 0.5f}) corners.push_back({x, y, z});
  const Shape hull = hull_shape(corners, "a cube");
  with.shapes.push_back(hull);
  for (const uint32_t shape : {2u, 4u, 3u}) with.bodies.push_back(body_at({2.0 * shape, 0.6, 0}, shape));
  with.bodies.push_back(body_at({4, 2, 0}, 1));
  World expected(with, {}, {"serial", {}}), world(empty_yard(), {}, {"serial", {}});
  CHECK(world.add_shape(hull) == 4);
  world.create_bodies(std::span(with.bodies).subspan(1));
  for (int k = 0; k < 90; ++k) {
    expected.step();
    world.step();
    CAPTURE(k);
    for (uint32_t body = 1; body < 5; ++body)
      REQUIRE(world.bodies()[body].position == expected.bodies()[body].position);
  }
}

TEST_CASE("a thousand bodies come and go in random order, and the rest stand as a brute-force list says", "[sanitizer]")
{
  Random random(11);
  World world(empty_yard(false), {}, {"serial", {}});
  std::vector<BodyId> alive;
  std::set<std::pair<uint32_t, uint32_t>> seen{{0, 1}};
  for (int round = 0; round < 60; ++round) {
    std::vector<Body> bodies;
    const auto created = static_cast<int>(random.uniform(0, 20));
    for (int k = 0; k < created; ++k)
      bodies.push_back(body_at({random.uniform(-20, 20), 1 + random.uniform(0, 5), random.uniform(-20, 20)},
                               1 + static_cast<uint32_t>(random.uniform(0, 3))));
    for (const BodyId &id : world.create_bodies(bodies)) {
      CHECK(seen.insert({id.index, id.generation}).second);
      alive.push_back(id);
    }
    std::vector<BodyId> doomed;
    const size_t dies = std::min<size_t>(alive.size(), static_cast<size_t>(random.uniform(0, 20)));
    for (size_t k = 0; k < dies; ++k) {
      const auto at = static_cast<size_t>(random.uniform(0, static_cast<double>(alive.size())));
      doomed.push_back(alive[at]);
      alive.erase(alive.begin() + static_cast<ptrdiff_t>(at));
    }
    world.destroy_bodies(doomed);
    for (const BodyId &id : doomed) CHECK_FALSE(world.exists(id));
    world.step();
    REQUIRE(world.body_count() == alive.size() + 1);
    for (const BodyState &state : world.read_bodies(alive)) REQUIRE(state.position[1] > 0);
  }
  CHECK(world.scene().bodies.size() < 400); /* places were used again */
}
