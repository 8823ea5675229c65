/* Bodies that miss each other keep their motion while gravity bends their path: they are thrown past each other in any
 * direction, at any moment of a step.
 *
 *        \   gravity |           The path is a parabola. Its least distance from the body at rest is found here by
 *         \          v           sampling it in double, and the path is placed so that this is the clearance. A body
 *          `.    .--.            with a speculative contact must follow that parabola, too: half of what gravity makes
 *            `-.( b  )           it fall within a substep is 1.4 mm in a sixtieth of a second, in each step.
 *       clearance`--'
 */
#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/free_fall.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A box, a ball, or what a ball of `round` covers on the way along a box; axes stand as those of the world. */
struct Form {
  Shape shape;
  Vector half; /* extents of the box */
  double round;
};

Form any_form(Random &random, int kind)
{
  const double size = logarithmic(random, 0.1, 2);
  const float s = float(size);
  const Vector cube(size, size, size), none(0, 0, 0);
  switch (kind) {
  case 0: return {sphere_shape(s), none, size};
  case 1: return {box_shape(s, s, s), cube, 0};
  case 2: return {hull_of_box(s, s, s), cube, 0};
  case 3: return {capsule_shape(s, 2 * s), {0, 2 * size, 0}, size};
  default: return {mesh_of_box(s, s, s), cube, 0};
  }
}
constexpr int mover_forms = 4, obstacle_forms = 5;

double gap_between(const Form &a, const Form &b, const Vector &offset)
{
  const Vector beside = offset.cwiseAbs() - a.half - b.half;
  return beside.cwiseMax(0.0).norm() + std::min(0.0, beside.maxCoeff()) - a.round - b.round;
}

/* A way that falls, seen from what it passes: `at` and with `velocity` at time 0. */
struct Flight {
  Vector at, velocity, gravity;
  Vector place(double time) const { return at + time * velocity + 0.5 * time * time * gravity; }
};

/* The search begins at the start; no step of it is longer than a third of a millimetre unless the gap is. */
double least_gap(const Form &a, const Form &b, const Flight &flight, double start, double end)
{
  const double fastest = flight.velocity.norm() + std::max(-start, end) * flight.gravity.norm();
  double least = 1e9;
  for (double time = start; time < end;) {
    const double gap = gap_between(a, b, flight.place(time));
    least = std::min(least, gap);
    time += std::max(3e-4, gap - 0.03) / fastest;
  }
  return least;
}

/* The distance along a direction from which on the flight keeps the clearance. */
Flight laid_past(const Form &a, const Form &b, Flight flight, const Vector &aside, double start, double end,
                 double clearance)
{
  double inside = 0, outside = 16;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (inside + outside);
    flight.at = middle * aside;
    (least_gap(a, b, flight, start, end) < clearance ? inside : outside) = middle;
  }
  flight.at = outside * aside;
  return flight;
}

/* is_free: what is passed falls, too. spin: of the balls that are passed, if not 0, rad/s. */
struct Throws {
  bool is_free = false;
  double spin = 0, least_clearance = 0.001;
};

constexpr int steps = 5;

void add_throw(Scene &scene, Random &random, int lane, double step, const Throws &throws)
{
  const Form obstacle =
                 any_form(random, throws.spin > 0 ? 0 : lane % (throws.is_free ? obstacle_forms - 1 : obstacle_forms)),
             mover = any_form(random, lane / obstacle_forms % mover_forms);
  const double speed = logarithmic(random, 1, 300), before = random.uniform(0.02, 3) * step;
  const double clearance = logarithmic(random, throws.least_clearance, 0.02), angle = random.uniform(0, 2 * pi);
  const Vector aside(0, std::cos(angle), std::sin(angle)),
      heading = Vector(1, random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7)).normalized();
  const Vector pull = throws.is_free ? Vector(0, 0, 0) : vector_of(scene.gravity);
  const double after = steps * step;
  const Flight flight =
      laid_past(obstacle, mover, {{0, 0, 0}, speed * heading, pull}, aside, -before, after, clearance);

  const Vector middle(0, 0, 100.0 * lane);
  if (throws.is_free) add_dynamic_body(scene, obstacle.shape, middle, {0, 0, 0, 1}, 1000);
  else
    add_body(scene, BodyType::kinematic, obstacle.shape, point_of(middle)).angular_velocity =
        vec3_of(throws.spin * direction(random));
  Body &body = add_dynamic_body(scene, mover.shape, middle + flight.place(-before));
  body.linear_velocity = vec3_of(flight.velocity - before * flight.gravity);
}

Scene thrown(uint64_t seed, double step, const Throws &throws)
{
  Random random(seed);
  Scene scene = empty_scene();
  scene.materials[0].restitution = 0.3f;
  for (int lane = 0; lane < 200; ++lane) add_throw(scene, random, lane, step, throws);
  return scene;
}

} // namespace

TEST_CASE("what misses goes on: in flight past what stands, spins or falls beside it, in every solver", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (double step : {1.0 / 60, 1.0 / 120})
    for (const Throws &throws : {Throws{}, Throws{true}, Throws{false, 30}}) {
      CAPTURE(solver, step, throws.is_free, throws.spin);
      CHECK(farthest_from_free_fall(thrown(11, step, throws), settings_for(solver), step, steps) < 5e-4);
    }
}

/* Contacts are followed along the chord of the step, from which gravity bends the way by g step^2 / 8: 1.4 mm. */
TEST_CASE("what misses goes on: in flight in steps of a thirtieth of a second, by more than the way bends", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  CAPTURE(solver);
  CHECK(farthest_from_free_fall(thrown(12, 1.0 / 30, {false, 0, 0.002}), settings_for(solver), 1.0 / 30, steps) < 5e-4);
}

TEST_CASE("what hits without friction feels no spin: balls that graze balls which something turns", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  Random random(5);
  Scene still = empty_scene({0, 0, 0});
  still.materials[0].static_friction = still.materials[0].dynamic_friction = 0;
  for (int lane = 0; lane < 200; ++lane) {
    const double z = 100.0 * lane, standing = logarithmic(random, 0.05, 2), flying = logarithmic(random, 0.05, 2);
    const double speed = logarithmic(random, 1, 100), before = speed / 60 * random.uniform(0, 3) + standing + flying;
    const double depth = logarithmic(random, 1e-5, 0.02) * std::min(standing, flying);
    add_body(still, BodyType::kinematic, sphere_shape(float(standing)), {0, 0, z});
    add_dynamic_body(still, sphere_shape(float(flying)), {-before, standing + flying - depth, z}).linear_velocity = {
        float(speed), 0, 0};
  }
  Scene spins = still;
  for (Body &body : spins.bodies)
    if (body.type == BodyType::kinematic)
      body.angular_velocity = vec3_of(logarithmic(random, 1, 60) * direction(random));
  World without(still, settings_for(solver), {"tbb", {}}), with(spins, settings_for(solver), {"tbb", {}});
  run(without, 60);
  run(with, 60);
  const std::vector<BodyState> expected = without.bodies(), states = with.bodies();
  int turned_aside = 0;
  for (size_t i = 1; i < states.size(); i += 2) {
    const Vector before = vector_of(still.bodies[i].linear_velocity), free = vector_of(expected[i].linear_velocity);
    CAPTURE(solver, i, free.transpose(), vector_of(states[i].linear_velocity).transpose());
    CHECK((vector_of(states[i].linear_velocity) - free).norm() < 1e-4 * before.norm());
    turned_aside += (free - before).norm() > 1e-3 * before.norm();
  }
  CHECK(turned_aside > 150);
}

/* A wall without friction bears nothing: what slides down it keeps its distance from what falls freely below it. */
TEST_CASE("what misses goes on: boxes that fall below one another, one of them along a wall, in every solver",
          "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (double gap : {0.0001, 0.001, 0.005}) {
    Scene scene = empty_scene();
    scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
    add_body(scene, BodyType::fixed, box_shape(1, 200, 1), {-1.5, 0, 0});
    add_dynamic_body(scene, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0});
    add_dynamic_body(scene, box_shape(0.4f, 0.5f, 0.4f), {0.05, -1 - gap, 0});
    World world(scene, settings_for(solver));
    for (int step = 0; step < 60; ++step) {
      world.step();
      const std::vector<BodyState> states = world.bodies();
      CAPTURE(solver, gap, step);
      CHECK(states[1].position[1] - states[2].position[1] - 1 == Approx(gap).margin(1e-5));
    }
    CHECK(world.bodies()[2].linear_velocity[1] == Approx(-10).epsilon(1e-5));
  }
}
