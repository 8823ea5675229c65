/* Locked axes and highest speeds of bodies: what is locked stays to the bit, and the rest moves by closed forms. */
#include <cmath>
#include <limits>
#include <vector>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/interface/features.h"
#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr Axes x_and_y{true, true, false}, only_z{false, false, true}, all{true, true, true};

std::vector<Solver> solvers_with_locks()
{
  std::vector<Solver> solvers = choices<Solver>();
  solvers.erase(std::find(solvers.begin(), solvers.end(), Solver::avbd));
  return solvers;
}

Scene weightless()
{
  Scene scene;
  scene.name = "weightless";
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.5f), box_shape(0.5f, 0.5f, 0.5f), box_shape(1, 0.2f, 0.3f)};
  return scene;
}

Body ground()
{
  Body body = body_at({0, -1, 0}, 3);
  body.type = BodyType::fixed;
  return body;
}

/* Boxes upon each other, turned and shifted a little, so that contacts push in all directions. */
Scene crooked_stack(const Axes &linear, const Axes &angular)
{
  Random random(7);
  Scene scene = weightless();
  scene.gravity = {0, -10, 1};
  scene.shapes.push_back(box_shape(20, 1, 20));
  scene.bodies = {ground()};
  for (int k = 0; k < 5; ++k) {
    Body body = body_at({random.uniform(-0.1, 0.1), 0.5 + 1.01 * k, random.uniform(-0.1, 0.1)}, 1);
    const auto half = static_cast<float>(random.uniform(-0.2, 0.2));
    if (!angular.y) body.orientation = {0, std::sin(half), 0, std::cos(half)};
    body.linear_locks = linear;
    body.angular_locks = angular;
    scene.bodies.push_back(body);
  }
  return scene;
}

void run(World &world, int steps)
{
  for (int k = 0; k < steps; ++k) world.step();
}

} // namespace

TEST_CASE("a stack with a locked axis that is pushed sideways keeps it to the bit", "[address]")
{
  const Solver solver = GENERATE(from_range(solvers_with_locks()));
  const Scene scene = crooked_stack(only_z, {});
  World world(scene, settings_for(solver), {"serial", {}});
  CAPTURE(solver);
  const std::vector<BodyState> before = world.bodies();
  double moved = 0;
  for (int k = 0; k < 90; ++k) {
    if (k % 30 == 10) world.add_impulse(world.id_of(2), {{1.5f, 0, 2}, {}, Point{0, 1.6, 0.3}});
    if (k % 30 == 20) world.add_force(world.id_of(4), {{40, 0, 90}});
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t body = 1; body < states.size(); ++body) {
      REQUIRE(states[body].position[2] == before[body].position[2]);
      REQUIRE(states[body].linear_velocity[2] == 0);
      moved = std::max(moved, std::abs(states[body].position[0] - before[body].position[0]));
    }
  }
  CHECK(moved > 0.03);
}

TEST_CASE("bodies of a plane stay in it and turn about its normal alone, to the bit", "[address]")
{
  const Solver solver = GENERATE(from_range(solvers_with_locks()));
  CAPTURE(solver);
  Scene scene = crooked_stack(only_z, x_and_y);
  for (size_t body = 1; body < scene.bodies.size(); ++body) {
    scene.bodies[body].shape = body % 2 ? 2 : 1; /* uneven moments of inertia as well */
    scene.bodies[body].position[1] = 1.2 * static_cast<double>(body);
    scene.bodies[body].angular_velocity = {3, 4, 2};
  }
  World world(scene, settings_for(solver), {"serial", {}});
  const std::vector<BodyState> before = world.bodies();
  float turned = 0;
  for (int k = 0; k < 90; ++k) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t body = 1; body < states.size(); ++body) {
      const BodyState &state = states[body];
      REQUIRE(state.position[2] == before[body].position[2]);
      REQUIRE((state.orientation[0] == 0 && state.orientation[1] == 0));
      REQUIRE((state.angular_velocity[0] == 0 && state.angular_velocity[1] == 0));
      turned = std::max(turned, std::abs(state.orientation[2]));
    }
  }
  CHECK(turned > 0.05f);
}

TEST_CASE("a body with all axes locked stands in the air, whatever falls on it", "[address]")
{
  const Solver solver = GENERATE(from_range(solvers_with_locks()));
  CAPTURE(solver);
  Scene scene = weightless();
  scene.gravity = {0, -10, 0};
  scene.bodies = {body_at({0, 3, 0}, 2), body_at({0.3, 5, 0.1}, 1)};
  scene.bodies[0].orientation = {0.1f, 0.2f, 0.3f, std::sqrt(1 - 0.14f)};
  scene.bodies[0].linear_locks = scene.bodies[0].angular_locks = all;
  World world(scene, settings_for(solver), {"serial", {}});
  const BodyState before = world.bodies()[0];
  double lowest = 9;
  for (int k = 0; k < 120; ++k) {
    world.step();
    lowest = std::min(lowest, world.bodies()[1].position[1]);
    REQUIRE(world.bodies()[0].position == before.position);
    REQUIRE(world.bodies()[0].orientation == before.orientation);
  }
  CHECK(lowest < 4.5); /* it has fallen as far as the other one */
}

/* n: from a to b; only b is free along z. The impulse of an elastic impact without friction is 2 v.n / (nx^2 / a + 1 /
 * b), where a free body would have 1 / a. */
TEST_CASE("an oblique impact on a locked body exchanges momentum by its mass along the free axes", "[sanitizer]")
{
  const Solver solver = GENERATE(from_range(solvers_with_locks()));
  CAPTURE(solver);
  Scene scene = weightless();
  scene.materials[0] = {};
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  scene.materials[0].restitution = 1;
  const double nx = 0.6, nz = 0.8, speed = 4, a = 2, b = 0.5;
  scene.bodies = {body_at({0, 0, 0}), body_at({1.5 * nx, 0, 1.5 * nz})};
  scene.bodies[0].mass = static_cast<float>(a);
  scene.bodies[1].mass = static_cast<float>(b);
  scene.bodies[1].linear_velocity = {static_cast<float>(-speed * nx), 0, static_cast<float>(-speed * nz)};
  scene.bodies[0].linear_locks = only_z;
  World world(scene, settings_for(solver), {"serial", {}});
  run(world, 30);
  const double impulse = 2 * speed / (nx * nx / a + 1 / b);
  const BodyState hit = world.bodies()[0], back = world.bodies()[1];
  CHECK(hit.linear_velocity[0] == Approx(-impulse * nx / a).epsilon(1e-3));
  CHECK(hit.linear_velocity[2] == 0);
  CHECK(back.linear_velocity[0] == Approx(-speed * nx + impulse * nx / b).epsilon(1e-3));
  CHECK(back.linear_velocity[2] == Approx(-speed * nz + impulse * nz / b).epsilon(1e-3));
  CHECK(world.statistics().kinetic_energy == Approx(0.5 * b * speed * speed).epsilon(1e-3));
}

TEST_CASE("a tilted slab on an axle turns by its moment of inertia about the axle", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0}, 2), body_at({9, 0, 0}, 2)};
  const Quat tilted{0.3f, 0.1f, 0.2f, std::sqrt(1 - 0.14f)};
  for (Body &body : scene.bodies) {
    body.mass = 3;
    body.orientation = tilted;
    body.angular_locks = x_and_y;
  }
  const Vec3 moments = inertia_of(scene.shapes[2], 3);
  const double x = tilted[0], y = tilted[1], z = tilted[2], w = tilted[3];
  const double row[3] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}; /* z in body axes */
  double moment = 0;
  for (int k = 0; k < 3; ++k) moment += row[k] * row[k] * moments[static_cast<size_t>(k)];
  World world(scene, {}, {"serial", {}});
  world.add_impulse(world.id_of(0), {{}, {0.7f, -0.4f, 2}});
  world.add_force(world.id_of(1), {{}, {42, -24, 120}});
  world.step();
  for (const BodyState &state : world.bodies()) {
    CHECK(state.angular_velocity[0] == 0);
    CHECK(state.angular_velocity[1] == 0);
    CHECK(state.angular_velocity[2] == Approx(2 / moment).epsilon(1e-4));
  }
  run(world, 59); /* it keeps turning at this speed: the axle takes up what is out of balance */
  CHECK(world.bodies()[0].angular_velocity[2] == Approx(2 / moment).epsilon(1e-4));
}

TEST_CASE("a lock that comes at run time holds from then on, and goes again", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0}), body_at({5, 0, 0})};
  scene.bodies[0].linear_velocity = scene.bodies[1].linear_velocity = {1, 2, 3};
  World world(scene, {}, {"serial", {}});
  run(world, 10);
  CHECK((world.features() & FEATURE_LOCKS) == 0);
  const BodyId ball = world.id_of(0);
  world.set_locks(ball, only_z, {});
  CHECK((world.features() & FEATURE_LOCKS) != 0);
  const BodyState before = world.read_body(ball);
  run(world, 30);
  const BodyState after = world.read_body(ball);
  CHECK(after.position[2] == before.position[2]);
  CHECK(after.position[1] == Approx(before.position[1] + 1));
  CHECK(after.linear_velocity == Vec3{1, 2, 0});
  CHECK(world.bodies()[1].linear_velocity == Vec3{1, 2, 3});
  world.set_locks(ball, {}, {});
  world.add_impulse(ball, {{0, 0, 1}});
  world.step();
  CHECK(world.read_body(ball).linear_velocity == Vec3{1, 2, 1});
}

TEST_CASE("the solver avbd refuses locks wherever they come from", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0})};
  const Settings settings = settings_for(Solver::avbd);
  World world(scene, settings, {"serial", {}});
  CHECK_THROWS_WITH(world.set_locks(world.id_of(0), only_z, {}),
                    ContainsSubstring("set_properties: body 0: linear_locks, angular_locks: the solver avbd"));
  scene.bodies[0].angular_locks = only_z;
  CHECK_THROWS_WITH(world.create_body(scene.bodies[0]), ContainsSubstring("create_bodies: body 0"));
  CHECK_THROWS_WITH(World(scene, settings, {"serial", {}}), ContainsSubstring("the solver avbd has no locks"));
  scene.bodies[0].type = BodyType::kinematic; /* has none */
  CHECK_NOTHROW(World(scene, settings, {"serial", {}}));
}

TEST_CASE("a falling body does not become faster than its highest speed", "[address]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  CAPTURE(solver);
  Scene scene = weightless();
  scene.gravity = {0, -10, 0};
  scene.bodies = {body_at({0, 100, 0}), body_at({9, 100, 0})};
  scene.bodies[0].max_linear_speed = 3;
  scene.bodies[0].angular_velocity = scene.bodies[1].angular_velocity = {0, 0, 5};
  scene.bodies[0].max_angular_speed = 2;
  World world(scene, settings_for(solver), {"serial", {}});
  run(world, 60);
  const BodyState before = world.bodies()[0];
  CHECK(before.linear_velocity[1] == Approx(-3).epsilon(1e-6));
  CHECK(before.angular_velocity[2] == Approx(2).epsilon(1e-6));
  run(world, 60);
  CHECK(world.bodies()[0].position[1] == Approx(before.position[1] - 3).margin(1e-4));
  CHECK(world.bodies()[1].position[1] == Approx(100 - 20).margin(1e-3));
  CHECK(world.bodies()[1].angular_velocity[2] == 5);
  world.set_max_speeds(world.id_of(0), std::numeric_limits<float>::infinity(), 1);
  run(world, 60);
  CHECK(world.bodies()[0].linear_velocity[1] == Approx(-13).epsilon(1e-5));
  CHECK(world.bodies()[0].angular_velocity[2] == Approx(1).epsilon(1e-6));
}

TEST_CASE("highest speeds that cannot be are refused, and user data is kept", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0})};
  scene.bodies[0].user_data = 7;
  World world(scene, {}, {"serial", {}});
  const BodyId ball = world.id_of(0);
  CHECK_THROWS_WITH(world.set_max_speeds(ball, 0, 1), ContainsSubstring("body 0: max_linear_speed is 0"));
  CHECK_THROWS_WITH(world.set_max_speeds(ball, 1, std::numeric_limits<float>::quiet_NaN()),
                    ContainsSubstring("body 0: max_angular_speed is nan"));
  CHECK(world.body_description(ball).user_data == 7);
  world.set_user_data(ball, UINT64_MAX - 1);
  CHECK(world.scene().bodies[0].user_data == UINT64_MAX - 1);
  CHECK(world.features() == World(scene, {}, {"serial", {}}).features());
}

TEST_CASE("going back to a state takes the locks of its bodies with it", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0}), body_at({9, 0, 0})};
  for (Body &body : scene.bodies) {
    body.linear_velocity = {1, 0, 1};
    body.linear_locks = only_z;
    body.max_linear_speed = 0.5f;
  }
  World world(scene, {}, {"serial", {}});
  world.keep_states(8);
  world.step();
  const std::vector<BodyState> before = world.bodies();
  const uint64_t hash = world.state_hash();
  world.destroy_body(world.id_of(1));
  world.step();
  Body free = body_at({9, 5, 0});
  free.linear_velocity = {0, 0, 1};
  REQUIRE(world.create_body(free).index == 1);
  world.step();
  CHECK(world.bodies()[1].position[2] > 0);
  world.go_back(2);
  REQUIRE(world.state_hash() == hash);
  run(world, 60);
  CHECK(world.bodies()[1].position[2] == before[1].position[2]);
  CHECK(world.bodies()[1].position[0] == Approx(before[1].position[0] + 0.5).margin(1e-4));
}
