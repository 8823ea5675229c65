/* Contact events: their times, their values against closed forms and momentum, and all of them against an oracle. */
#include <cstdint>
#include <limits>
#include <map>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/event_oracle.h"
#include "tests/physics/event_settings.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Kind = ContactEvent::Kind;

/* One letter a step for the pair (a, b): b, p, e, or . for no event. */
class History {
public:
  History(uint32_t a, uint32_t b) : bodies_(a, b) {}
  void add(World &world)
  {
    char letter = '.';
    for (const ContactEvent &event : world.contact_events())
      if (std::pair{event.a, event.b} == bodies_) letter = *name_of(event.kind);
    letters_ += letter;
  }
  const std::string &letters() const { return letters_; }

private:
  std::pair<uint32_t, uint32_t> bodies_;
  std::string letters_;
};

std::string run_history(World &world, int steps, uint32_t a = 0, uint32_t b = 1)
{
  History history(a, b);
  for (int i = 0; i < steps; ++i) {
    world.step();
    history.add(world);
  }
  return history.letters();
}

Scene ball_above_ground(double height, float restitution)
{
  Scene scene = empty_scene();
  const uint32_t material = add_material(scene, 0.5f, restitution);
  add_ground(scene).material = material;
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, height, 0}).material = material;
  return scene;
}

/* Compares the events of one step with those of the oracle. */
void require_oracle(World &world, const EventOracle &oracle)
{
  std::map<std::pair<uint32_t, uint32_t>, Kind> expected;
  for (const auto &[bodies, contact] : oracle.now())
    expected[bodies] = oracle.before().count(bodies) ? Kind::persist : Kind::begin;
  for (const auto &[bodies, contact] : oracle.before())
    if (!oracle.now().count(bodies)) expected[bodies] = Kind::end;
  const std::vector<ContactEvent> events = world.contact_events();
  REQUIRE(events.size() == expected.size());
  auto next = expected.begin();
  for (const ContactEvent &event : events) {
    CAPTURE(event.a, event.b);
    REQUIRE(std::pair{event.a, event.b} == next->first);
    REQUIRE(event.kind == next->second);
    REQUIRE(event.trigger == (world.scene().bodies[event.a].trigger || world.scene().bodies[event.b].trigger));
    ++next;
    if (event.kind == Kind::end) {
      REQUIRE((event.points == 0 && event.impulse == 0));
      continue;
    }
    const EventOracle::Contact &contact = oracle.now().at({event.a, event.b});
    REQUIRE(event.points == contact.points);
    REQUIRE(event.impulse == Approx(contact.impulse).epsilon(1e-6));
    REQUIRE(double(event.separation) == contact.separation);
    if (contact.manifolds > 1) continue;
    REQUIRE((vector_of(event.point) - contact.point).norm() < 1e-5);
    REQUIRE(vector_of(event.normal) == contact.normal);
  }
}

} // namespace

TEST_CASE("a dropped ball begins to touch once and then persists for as long as it rests", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  CAPTURE(solver);
  World world(ball_above_ground(2, 0), with_events(solver), {"serial", {}});
  const std::string history = run_history(world, 240);
  const size_t begins = history.find('b');
  /* 1.5 m take 0.5477 s, 32.9 steps. */
  CHECK(begins == 32);
  CHECK(history == std::string(begins, '.') + "b" + std::string(239 - begins, 'p'));
  const ContactEvent at_rest = world.contact_events().at(0);
  CHECK(at_rest.impulse == Approx(gravity / 60).epsilon(1e-4)); /* 1 kg is carried for a step */
  CHECK(at_rest.normal == Vec3{0, 1, 0});
  CHECK(at_rest.points == 1);
  CHECK(at_rest.point[1] == Approx(0).margin(0.003));
}

TEST_CASE("what a bouncing ball's events carry is its change of momentum, in every step", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  const float restitution = GENERATE(0.0f, 0.5f, 1.0f);
  CAPTURE(solver, restitution);
  Scene scene = ball_above_ground(1.7, restitution);
  scene.bodies[1].mass = 3;
  scene.bodies[1].linear_velocity = {1, -20, 0};
  World world(scene, with_events(solver), {"serial", {}});
  int bounces = 0;
  for (int i = 0; i < 150; ++i) {
    const double before = world.bodies()[1].linear_velocity[1];
    world.step();
    const double change = world.bodies()[1].linear_velocity[1] - before + gravity / 60;
    double impulse = 0;
    for (const ContactEvent &event : world.contact_events()) {
      impulse += event.impulse;
      bounces += event.kind == Kind::begin;
    }
    CAPTURE(i);
    REQUIRE(impulse == Approx(3 * change).margin(3 * 20 * 4e-7)); /* roundings of velocities */
  }
  CHECK(bounces == (restitution == 0 ? 1 : 2) - (restitution == 1));
}

/* Without friction nothing else acts, so the events of a pile must account for the momentum of each body by itself. */
TEST_CASE("the events of a smooth pile account for the momentum of every body in every step", "[physics]")
{
  const Solver solver =
      GENERATE(Solver::soft_step, Solver::pgs, Solver::nncg, Solver::jacobi, Solver::xpbd, Solver::direct);
  CAPTURE(solver);
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  scene.materials[0].restitution = 0.3f;
  add_ground(scene);
  Random random(7);
  for (int i = 0; i < 24; ++i) {
    const Shape shapes[] = {sphere_shape(0.3f), box_shape(0.3f, 0.25f, 0.35f), capsule_shape(0.2f, 0.2f)};
    add_dynamic_body(scene, shapes[i % 3],
                     {0.5 * (i % 2) + random.uniform(-0.1, 0.1), 0.4 + 0.45 * (i / 4), 0.5 * (i / 2 % 2)},
                     random.orientation(), float(random.uniform(0.5, 2)));
  }
  World world(scene, with_events(solver), {"serial", {}});
  size_t events = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<BodyState> before = world.bodies();
    world.step();
    const std::vector<BodyState> after = world.bodies();
    std::vector<Vector> pushed(after.size(), Vector::Zero());
    for (const ContactEvent &event : world.contact_events()) {
      pushed[event.a] -= double(event.impulse) * vector_of(event.normal);
      pushed[event.b] += double(event.impulse) * vector_of(event.normal);
      ++events;
    }
    for (size_t k = 1; k < after.size(); ++k) {
      const Vector free = vector_of(before[k].linear_velocity) + Vector(0, -gravity / 60, 0);
      const Vector change = double(scene.bodies[k].mass) * (vector_of(after[k].linear_velocity) - free);
      CAPTURE(i, k, change.transpose(), pushed[k].transpose());
      REQUIRE((pushed[k] - change).norm() < 2e-5);
    }
  }
  CHECK(events > 60 * 10);
}

/* A rod that turns by radians within a substep hands on less than it has carried. */
TEST_CASE("the events of rods that spin fast account for their momentum in every step", "[physics]")
{
  Random random(4);
  int hits = 0;
  for (int i = 0; i < 100; ++i) {
    Scene scene = empty_scene({0, 0, 0});
    scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
    add_dynamic_body(scene, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}, any_turn(random), 1);
    const Vector above(random.uniform(-0.3, 0.3), 1.2, random.uniform(-0.3, 0.3));
    Body &rod = add_dynamic_body(scene, box_shape(0.5f, 0.02f, 0.02f), above, any_turn(random), 1);
    rod.linear_velocity = {0, -float(random.uniform(5, 60)), 0};
    rod.angular_velocity = vec3_of(logarithmic(random, 30, 1000) * direction(random));
    World world(scene, with_events(Solver::soft_step), {"serial", {}});
    for (int step = 0; step < 8; ++step) {
      const Vector before = vector_of(world.bodies()[1].linear_velocity);
      world.step();
      const Vector change = vector_of(world.bodies()[1].linear_velocity) - before;
      Vector pushed = Vector::Zero();
      for (const ContactEvent &event : world.contact_events())
        pushed += double(event.impulse) * vector_of(event.normal);
      CAPTURE(i, step, change.transpose(), pushed.transpose());
      REQUIRE((pushed - change).norm() < 2e-5);
      hits += pushed.norm() > 0;
    }
  }
  CHECK(hits > 200);
}

TEST_CASE("a ball that slides over an edge ceases to touch where the edge is", "[physics]")
{
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  add_body(scene, BodyType::fixed, box_shape(1, 0.5f, 1), {0, -0.5, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {-0.5, 0.2, 0}).linear_velocity = {
      3, 0, 0}; /* v^2 / r > g: it flies off */
  World world(scene, with_events(), {"serial", {}});
  const std::string history = run_history(world, 60);
  /* The centre is over the edge after 1.5 m, 30 steps: it starts step 30 there, and falls free. */
  const size_t ends = history.find('e');
  CAPTURE(history);
  CHECK((ends == 30 || ends == 31));
  CHECK(history == "b" + std::string(ends - 1, 'p') + "e" + std::string(59 - ends, '.'));
}

TEST_CASE("a contact ends also where the pair is gone from the list: carried off, or taken out", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(10, 0.5f, 10), {0, -0.5, 0});
  for (const double x : {0, 5}) add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {x, 0.5, 0});
  World world(scene, with_events(), {"serial", {}});
  run(world, 3);
  REQUIRE(world.contact_events().size() == 2);
  BodyState state = world.bodies()[1];
  state.position = {0, 100, 0};
  world.set_body(1, state);
  CHECK(run_history(world, 2) == "e.");
  REQUIRE(world.statistics().pairs == 1);
  state = world.bodies()[2];
  state.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  world.set_body_unchecked(2, state); /* the step runs again without it, and is one step */
  CHECK(run_history(world, 2, 0, 2) == "e.");
  CHECK(world.quarantined().size() == 1);
}

TEST_CASE("every event of a random pile, against the oracle", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::jacobi);
  Scene scene = load_scene("mixed:n=60");
  Random random(3);
  for (int i = 0; i < 6; ++i) {
    Body zone;
    zone.name = "zone";
    zone.type = BodyType(i % 3);
    zone.trigger = true;
    zone.position = {random.uniform(-2, 2), random.uniform(0, 3), random.uniform(-2, 2)};
    zone.linear_velocity = {0, 0, i % 3 == 1 ? 0.5f : 0.0f};
    scene.shapes.push_back(i % 2 ? sphere_shape(1) : box_shape(0.7f, 0.4f, 1));
    zone.shape = uint32_t(scene.shapes.size() - 1);
    scene.bodies.push_back(zone);
  }
  World world(scene, with_events(solver), {"tbb", {}});
  EventOracle oracle(world);
  std::map<std::pair<Kind, bool>, int> seen;
  for (int i = 0; i < 100; ++i) {
    world.step();
    CAPTURE(i, solver);
    require_oracle(world, oracle);
    for (const ContactEvent &event : world.contact_events()) ++seen[{event.kind, event.trigger}];
  }
  for (const Kind kind : {Kind::begin, Kind::persist, Kind::end})
    for (const bool trigger : {false, true}) {
      CAPTURE(name_of(kind), trigger);
      CHECK(seen[{kind, trigger}] > 5);
    }
}

/* Balls in a heap, and triggers that fly into it: all against all, so that pairs outgrow their buffers in the middle of
 * the run. */
TEST_CASE("a step that runs again with larger buffers tells its events once", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  scene.shapes = {sphere_shape(0.3f), sphere_shape(1)};
  Random random(5);
  for (int i = 0; i < 120; ++i) {
    const double distance = i % 2 ? 4 : 1;
    const Vector from = distance * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Body body;
    body.position = point_of(from);
    body.linear_velocity = vec3_of(i % 2 ? -2 * from : -0.2 * from);
    body.trigger = i % 2;
    body.shape = i % 2;
    scene.bodies.push_back(body);
  }
  World world(scene, with_events(), {"tbb", {}});
  EventOracle oracle(world);
  uint32_t began = 0, repeated_after = 0;
  for (int i = 0; i < 40; ++i) {
    const uint32_t overflow = world.statistics().overflow;
    world.step();
    CAPTURE(i);
    require_oracle(world, oracle);
    if (world.statistics().overflow > overflow && began > 0) ++repeated_after;
    for (const ContactEvent &event : world.contact_events()) began += event.kind == Kind::begin;
  }
  CHECK(repeated_after > 0); /* with a cache that the repeated step had to leave alone */
}

TEST_CASE("events change no motion, cost nothing unless asked for, and are refused then", "[physics]")
{
  const Scene scene = load_scene("mixed:n=40");
  World silent(scene), telling(scene, with_events());
  run(silent, 40);
  run(telling, 40);
  CHECK(silent.body_hash() == telling.body_hash());
  CHECK_THROWS_AS(silent.contact_events(), InputError);
  CHECK(!telling.contact_events().empty());
  const std::vector<Kernel> kernels = silent.kernels();
  CHECK(std::none_of(kernels.begin(), kernels.end(),
                     [](Kernel kernel) { return row_of(kernel).stage == Stage::events; }));
  for (const Buffer buffer :
       {Buffer::constraint_impulse, Buffer::pair_impulse, Buffer::pair_touching, Buffer::event_start,
        Buffer::event_bodies, Buffer::event_contact, Buffer::cached_touching}) {
    CHECK(silent.memory().bytes(buffer) == 0);
    CHECK(telling.memory().bytes(buffer) > 0);
  }
}

TEST_CASE("a contact 1000 km from the origin is told to the millimetre", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(1, 0.5f, 1), {1e6, -0.5, 2e5});
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {1e6 + 0.123, 0.2, 2e5 + 0.456});
  World world(scene, with_events(), {"serial", {}});
  run(world, 30);
  const ContactEvent event = world.contact_events().at(0);
  CHECK(std::abs(event.point[0] - (1e6 + 0.123)) < 1e-3);
  CHECK(std::abs(event.point[2] - (2e5 + 0.456)) < 1e-3);
}

TEST_CASE("a ball that meets a wall within the step is told to have done so where they met", "[physics]")
{
  const float speed = GENERATE(5.0f, 30.0f, 300.0f);
  for (int start = 1; start <= 9; ++start) {
    Scene scene = empty_scene({0, 0, 0});
    add_body(scene, BodyType::fixed, box_shape(0.5f, 5, 5), {0.5, 0, 0});
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.05f), {-0.05 - 0.1 * start * speed / 60, 0.3, -0.2});
    ball.linear_velocity = {speed, 0, 0};
    World world(scene, with_events(), {"serial", {}});
    world.step();
    const std::vector<ContactEvent> events = world.contact_events();
    CAPTURE(speed, start);
    REQUIRE(events.size() == 1);
    CHECK(events[0].point[0] == Approx(0).margin(1e-3));
    CHECK(events[0].point[1] == Approx(0.3).margin(1e-3));
    CHECK(events[0].impulse == Approx(speed).epsilon(0.01));
  }
}

TEST_CASE("an impulse that has faded away has no place of its own: the event names the middle of the points",
          "[physics]")
{
  size_t faded = 0;
  for (const auto &[solver, scene] : {std::pair(Solver::pgs, "mixed:n=32"), std::pair(Solver::pgs, "mixed:n=40"),
                                      std::pair(Solver::nncg, "mixed:n=16"), std::pair(Solver::nncg, "mixed:n=48")}) {
    Settings settings = settings_for(solver); /* whose impulses fade to denormal numbers */
    settings.events = true;
    World world(load_scene(scene), settings);
    for (int step = 0; step < 300; ++step) {
      world.step();
      for (const ContactEvent &event : world.contact_events()) {
        faded += event.impulse > 0 && event.impulse < std::numeric_limits<float>::min();
        REQUIRE(vector_of(event.point).allFinite());
      }
    }
  }
  CHECK(faded > 0);
}
