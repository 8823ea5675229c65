/* Triggers: the bodies that are reported, from when to when against closed forms, and that no body is pushed. */
#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/event_settings.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Kind = ContactEvent::Kind;

double distance_to_box(const Vector &p, const Vector &half) { return (p.cwiseAbs() - half).cwiseMax(0.0).norm(); }

} // namespace

TEST_CASE("a ball through a trigger: begin and end in their steps, on the same path to the bit", "[physics][trigger]")
{
  const Broadphase broadphase = GENERATE(Broadphase::grid, Broadphase::sap, Broadphase::brute_force);
  Scene scene = empty_scene();
  Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {-2, 3, 0.1});
  ball.linear_velocity = {4, 0, 0.1f};
  ball.angular_velocity = {3, 1, 0};
  Settings settings = with_events();
  settings.broadphase = broadphase;
  World alone(scene, settings, {"serial", {}});
  const Vector half(0.5, 0.7, 0.6);
  add_body(scene, BodyType::fixed, box_shape(0.5f, 0.7f, 0.6f), {0, 1.5, 0}).trigger = true;
  World world(scene, settings, {"serial", {}});
  int overlaps = 0;
  bool overlapped = false;
  for (int i = 0; i < 60; ++i) {
    const bool overlaps_now = distance_to_box(vector_of(world.bodies()[0].position) - Vector(0, 1.5, 0), half) <= 0.2;
    world.step();
    alone.step();
    const std::vector<ContactEvent> events = world.contact_events();
    CAPTURE(i, broadphase);
    REQUIRE(events.size() == (overlaps_now || overlapped ? 1 : 0));
    if (!events.empty()) {
      CHECK(events[0].kind == (!overlaps_now ? Kind::end : overlapped ? Kind::persist : Kind::begin));
      CHECK((events[0].a == 0 && events[0].b == 1 && events[0].trigger && events[0].impulse == 0));
    }
    REQUIRE(world.bodies()[0].position == alone.bodies()[0].position);
    REQUIRE(world.bodies()[0].orientation == alone.bodies()[0].orientation);
    REQUIRE(world.bodies()[0].linear_velocity == alone.bodies()[0].linear_velocity);
    overlaps += overlaps_now;
    overlapped = overlaps_now;
  }
  CHECK(overlaps > 10);
  const Statistics statistics = world.statistics();
  CHECK(statistics.max_penetration == 0);
}

/* A body that is wholly inside another one must not look as if it had left. */
TEST_CASE("a body of any shape through a trigger of any shape is in it once, without a gap", "[physics][trigger]")
{
  const Shape shapes[] = {sphere_shape(1),         box_shape(1, 0.9f, 1.1f), capsule_shape(0.7f, 0.5f),
                          cylinder_shape(1, 0.9f), cone_shape(1.2f, 1),      hull_of_box(1, 0.9f, 1.1f)};
  const float size = GENERATE(0.1f, 0.9f);
  Scene scene = empty_scene({0, 0, 0});
  for (const Shape &trigger : shapes)
    for (Shape moving :
         {sphere_shape(size), box_shape(size, size, size), capsule_shape(0.5f * size, 0.5f * size),
          cylinder_shape(size, 0.5f * size), cone_shape(size, 0.5f * size), hull_of_box(size, size, size)}) {
      const double z = 10.0 * double(scene.bodies.size());
      Body &zone = add_dynamic_body(scene, trigger, {0, 0, z}, turn_about({0.3, 1, 0.2}, 0.7));
      zone.type = BodyType::fixed;
      zone.trigger = true;
      Body &body = add_dynamic_body(scene, moving, {-3.5, 0.05, z + 0.07});
      body.linear_velocity = {3, 0, 0};
      body.angular_velocity = {0.2f, 1, 0.5f};
    }
  World world(scene, with_events(), {"tbb", {}});
  const uint32_t pairs = uint32_t(scene.bodies.size() / 2);
  std::vector<std::string> history(pairs);
  for (int i = 0; i < 150; ++i) {
    world.step();
    std::string letters(pairs, '.');
    for (const ContactEvent &event : world.contact_events()) {
      REQUIRE(event.a % 2 == 0);
      REQUIRE(event.b == event.a + 1);
      letters[event.a / 2] = *name_of(event.kind);
    }
    for (uint32_t k = 0; k < pairs; ++k) history[k] += letters[k];
  }
  for (uint32_t k = 0; k < pairs; ++k) {
    CAPTURE(k, size, history[k]);
    const size_t begins = history[k].find('b'), ends = history[k].find('e');
    REQUIRE((begins != std::string::npos && ends != std::string::npos));
    CHECK((begins < 70 && ends > 71)); /* the body's centre passes the middle after 70 steps of 5 cm */
    CHECK(history[k] ==
          std::string(begins, '.') + "b" + std::string(ends - begins - 1, 'p') + "e" + std::string(149 - ends, '.'));
  }
}

TEST_CASE("who meets a trigger: whatever is none itself, where one of the two moves", "[physics][trigger]")
{
  const BodyType motions[] = {BodyType::fixed, BodyType::kinematic, BodyType::dynamic};
  struct Case {
    BodyType first, second;
    bool first_trigger, second_trigger, half_space;
  };
  std::vector<Case> cases;
  for (const BodyType first : motions)
    for (const BodyType second : motions)
      for (const bool first_trigger : {false, true})
        for (const bool second_trigger : {false, true})
          cases.push_back({first, second, first_trigger, second_trigger, false});
  Scene scene = empty_scene({0, 0, 0});
  const auto add = [&](const Case &c) {
    const double x = 5.0 * double(scene.bodies.size());
    for (const bool second : {false, true}) {
      Body &body = add_body(scene, second ? c.second : c.first, box_shape(0.5f, 0.5f, 0.5f), {x + 0.3 * second, 0, 0});
      body.trigger = second ? c.second_trigger : c.first_trigger;
    }
  };
  for (const Case &c : cases) add(c);
  World world(scene, with_events(), {"serial", {}});
  world.step();
  std::vector<bool> found(cases.size());
  for (const ContactEvent &event : world.contact_events()) {
    REQUIRE((event.a % 2 == 0 && event.b == event.a + 1));
    found[event.a / 2] = true;
  }
  const auto is_dynamic = [](const Case &c) { return c.first == BodyType::dynamic || c.second == BodyType::dynamic; };
  size_t solids = 0;
  for (size_t k = 0; k < cases.size(); ++k) {
    const Case &c = cases[k];
    CAPTURE(int(c.first), int(c.second), c.first_trigger, c.second_trigger);
    const bool both = c.first_trigger && c.second_trigger, either = c.first_trigger || c.second_trigger;
    const bool moves = c.first != BodyType::fixed || c.second != BodyType::fixed;
    CHECK(found[k] == (either ? !both && moves : is_dynamic(c)));
    solids += !either && is_dynamic(c);
  }
  CHECK(world.statistics().manifolds == solids); /* nothing of a trigger is solved */
  CHECK(world.statistics().contacts <= 4 * solids);
}

TEST_CASE("a half-space as a trigger: kinematic and dynamic bodies enter it, other half-spaces do not",
          "[physics][trigger]")
{
  Scene scene = empty_scene();
  add_ground(scene).trigger = true;
  Body &lift = add_body(scene, BodyType::kinematic, box_shape(0.5f, 0.5f, 0.5f), {0, 1, 0});
  lift.linear_velocity = {0, -1, 0};
  add_body(scene, BodyType::dynamic, capsule_shape(0.2f, 0.3f), {5, 1, 0});
  add_body(scene, BodyType::kinematic, half_space_shape(), {0, -20, 0}).linear_velocity = {0, 1, 0};
  World world(scene, with_events(), {"serial", {}});
  /* The lift's face is there after 0.5 s, 30 steps, give or take a rounding; the capsule falls 0.5 m in 0.316 s, 19
   * steps. */
  for (int i = 0; i < 50; ++i) {
    const std::vector<BodyState> states = world.bodies();
    world.step();
    std::vector<bool> inside(4);
    for (const ContactEvent &event : world.contact_events()) {
      REQUIRE(event.a == 0);
      inside[event.b] = event.kind != Kind::end;
    }
    CAPTURE(i);
    CHECK(inside[1] == (states[1].position[1] - 0.5 <= 0));
    CHECK(inside[2] == (states[2].position[1] - 0.5 <= 0));
    CHECK(!inside[3]);
  }
  CHECK(world.bodies()[2].position[1] < -1); /* it fell through */
}

TEST_CASE("a trigger that falls is reported by what it falls through, and rests on nothing", "[physics][trigger]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(2, 0.2f, 2), {0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0, 1.5, 0}).trigger = true;
  World world(scene, with_events(), {"serial", {}});
  std::string history;
  for (int i = 0; i < 60; ++i) {
    world.step();
    const auto events = world.contact_events();
    history += events.empty() ? '.' : *name_of(events[0].kind);
  }
  CHECK(history.find('b') < history.find('e'));
  CHECK(std::count(history.begin(), history.end(), 'b') == 1);
  CHECK(world.bodies()[1].position[1] == Approx(1.5 - 0.5 * gravity).margin(1e-3)); /* after 1 s */
}

TEST_CASE("batches are proven with triggers among them", "[physics][trigger]")
{
  for (const Batching batching : choices<Batching>()) {
    Scene scene = empty_scene();
    add_ground(scene);
    for (int i = 0; i < 30; ++i) {
      Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f),
                            {0.5 * (i % 3), 0.3 + 0.6 * (i / 6), 0.5 * (i / 3 % 2)});
      body.trigger = i % 5 == 0;
      body.gravity_factor = body.trigger ? 0.0f : 1.0f;
    }
    Settings settings = with_events();
    settings.batching = batching;
    settings.check = true;
    World world(scene, settings, {"serial", {}});
    run(world, 20);
    CAPTURE(batching);
    if (world.batch_fault()) FAIL(describe(*world.batch_fault()));
    const auto events = world.contact_events();
    CHECK(std::any_of(events.begin(), events.end(), [](const ContactEvent &event) { return event.trigger; }));
    CHECK(std::any_of(events.begin(), events.end(), [](const ContactEvent &event) { return !event.trigger; }));
  }
}
