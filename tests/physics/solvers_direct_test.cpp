/* The solver direct: against a brute-force oracle, where the soft step is too soft, and in the closed forms of every
 * solver. */
#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/contact_oracle.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings direct(double step = 1.0 / 60, uint32_t substeps = 4)
{
  Settings settings = settings_for(Solver::direct);
  settings.step = float(step);
  settings.substeps = substeps;
  return settings;
}

/* --- oracle ------------------------------------------------------------------------------------------ */

constexpr double instant = 1e-5; /* s: nothing moves noticeably within a step */
constexpr float overlap = 1e-5f; /* m: within the slop, so that neither distance nor penetration asks for a speed */

struct OracleCase {
  Scene scene;
  std::vector<OracleManifold> manifolds;
};

OracleCase sliding_cube()
{
  OracleCase c{empty_scene(), {}};
  c.scene.materials[0].static_friction = c.scene.materials[0].dynamic_friction = 0.4f;
  add_ground(c.scene);
  Body &cube = add_body(c.scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f - overlap, 0});
  cube.linear_velocity = {2, -1.5f, 1};
  cube.angular_velocity = {0.4f, 3, 0.2f};
  c.manifolds.push_back(box_on_face(c.scene, 0, 1, 0.4));
  return c;
}

/* Cubes that get smaller, of unlike masses, the upper ones kicked. */
OracleCase kicked_tower()
{
  OracleCase c{empty_scene(), {}};
  c.scene.materials[0].static_friction = c.scene.materials[0].dynamic_friction = 0.5f;
  add_ground(c.scene);
  float height = 0;
  const float sizes[3] = {0.5f, 0.375f, 0.25f}, masses[3] = {1, 5, 0.5f};
  for (int k = 0; k < 3; ++k) {
    Body &cube = add_body(c.scene, BodyType::dynamic, box_shape(sizes[k], sizes[k], sizes[k]),
                          {0.05f * float(k), height + sizes[k] - overlap, 0});
    cube.mass = masses[k];
    cube.linear_velocity = {0.5f * float(k), -1.0f - 0.5f * float(k), 0.2f * float(k * k)};
    height += 2 * sizes[k] - overlap;
    c.manifolds.push_back(box_on_face(c.scene, size_t(k), size_t(k) + 1, 0.5));
  }
  return c;
}

/* A ball thrown into a groove between two half-spaces. */
OracleCase ball_in_wedge()
{
  OracleCase c{empty_scene(), {}};
  c.scene.materials[0].static_friction = c.scene.materials[0].dynamic_friction = 0.3f;
  const float radius = 0.5f;
  Body &ball =
      add_body(c.scene, BodyType::dynamic, sphere_shape(radius), {0, (radius - overlap) * float(std::sqrt(2.0)), 0});
  ball.linear_velocity = {0.3f, -2, 0.5f};
  ball.angular_velocity = {1, 2, -4};
  const Vector center = vector_of(ball.position);
  for (const double side : {-1.0, 1.0}) {
    add_body(c.scene, BodyType::fixed, half_space_shape(), {0, 0, 0}).orientation =
        turn_about({0, 0, 1}, side * pi / 4);
    const Vector normal = axes_of(c.scene.bodies.back().orientation).col(1);
    c.manifolds.push_back(
        {c.scene.bodies.size() - 1, 0, normal, {Vector(center - (radius - 0.5 * overlap) * normal)}, 0.3, {}});
  }
  return c;
}

void require_oracle(const OracleCase &c, const std::string &backend)
{
  World world(c.scene, direct(instant, 1), Placement{backend, {}, false});
  world.step();
  OracleSolution expected = ContactOracle(oracle_bodies(c.scene, instant), c.manifolds).solve();
  CAPTURE(backend, expected.movement);
  CHECK(expected.movement < 1e-9);
  CHECK(world.statistics().manifolds == c.manifolds.size());
  CHECK(world.statistics().direct_stalled == 0);
  const std::vector<BodyState> now = world.bodies();
  for (size_t i = 0; i < now.size(); ++i) {
    CAPTURE(i, expected.bodies[i].linear, expected.bodies[i].angular, vector_of(now[i].linear_velocity),
            vector_of(now[i].angular_velocity));
    CHECK((vector_of(now[i].linear_velocity) - expected.bodies[i].linear).norm() < 3e-4);
    CHECK((vector_of(now[i].angular_velocity) - expected.bodies[i].angular).norm() < 1e-3);
  }
}

/* --- stacks -------------------------------------------------------------------------------------------- */

Scene stack(const std::vector<float> &masses)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (size_t k = 0; k < masses.size(); ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f + float(k), 0}).mass = masses[k];
  return scene;
}

struct Stand {
  double deepest = 0, sideways = 0, energy = 0;
  uint32_t stalled = 0;
};

Stand stand_still(const Scene &scene, const Settings &settings, int steps)
{
  World world(scene, settings, Placement{"tbb:threads=1", {}, false});
  Stand result;
  for (int k = 0; k < steps; ++k) {
    world.step();
    const Statistics now = world.statistics();
    result.deepest = std::max(result.deepest, now.max_penetration);
    result.stalled += now.direct_stalled;
    result.energy = now.kinetic_energy;
  }
  const std::vector<BodyState> states = world.bodies();
  REQUIRE(all_finite(states));
  for (const BodyState &state : states)
    result.sideways = std::max<double>(result.sideways, std::hypot(state.position[0], state.position[2]));
  return result;
}

} // namespace

TEST_CASE("direct: a cube that lands sliding and spinning, against the oracle", "[physics][direct]")
{
  for (const char *backend : {"serial", "reference"}) require_oracle(sliding_cube(), backend);
}

TEST_CASE("direct: a kicked tower of unlike masses, against the oracle", "[physics][direct]")
{
  for (const char *backend : {"serial", "reference"}) require_oracle(kicked_tower(), backend);
}

TEST_CASE("direct: a ball thrown into a wedge, against the oracle", "[physics][direct]")
{
  for (const char *backend : {"serial", "reference"}) require_oracle(ball_in_wedge(), backend);
}

TEST_CASE("direct: a heavy box stands on a light one, where the soft step sinks", "[physics][direct]")
{
  const float ratio = GENERATE(1000.0f, 10000.0f);
  const Scene scene = stack({1, ratio});
  const Stand exact = stand_still(scene, direct(), 120),
              soft = stand_still(scene, settings_for(Solver::soft_step), 120);
  INFO("1 : " << ratio << ": direct " << exact.deepest << " m deep, soft-step " << soft.deepest << "; stalled "
              << exact.stalled);
  CHECK(exact.deepest < 0.001);
  CHECK(exact.sideways < 0.001);
  CHECK(soft.deepest > 10 * exact.deepest + 0.005);
}

TEST_CASE("direct: twenty boxes whose masses double stand", "[physics][direct]")
{
  std::vector<float> masses;
  for (int k = 0; k < 20; ++k) masses.push_back(float(1 << k));
  const Stand result = stand_still(stack(masses), direct(), 40);
  INFO("twenty boxes, 1 to 524288 kg: " << result.deepest << " m deep, sideways " << result.sideways << " m; stalled "
                                        << result.stalled);
  CHECK(result.deepest < 0.001);
  CHECK(result.sideways < 0.001);
}

TEST_CASE("direct: a stack of ten stands three hundred steps", "[physics][direct]")
{
  const Stand result = stand_still(stack(std::vector<float>(10, 1.0f)), direct(), 300);
  INFO("ten boxes: " << result.deepest << " m deep, sideways " << result.sideways << " m, " << result.energy
                     << " J; stalled " << result.stalled);
  CHECK(result.deepest < 1e-4);
  CHECK(result.sideways < 1e-4);
  CHECK(result.energy < 1e-6);
}

TEST_CASE("direct: what is pressed in comes out without a jump", "[physics][direct]")
{
  Scene scene = stack({1, 1, 1});
  for (size_t i = 1; i < scene.bodies.size(); ++i) scene.bodies[i].position[1] -= 0.05f * float(i);
  World world(scene, direct());
  double fastest = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    for (const BodyState &state : world.bodies())
      fastest = std::max<double>(fastest, vector_of(state.linear_velocity).norm());
  }
  INFO("fastest body " << fastest << " m/s, penetration left " << world.statistics().max_penetration);
  CHECK(fastest < 0.2);
  CHECK(world.statistics().max_penetration < 0.0065);
  CHECK(world.statistics().max_penetration > 0.0035); /* the slop stays */
}

TEST_CASE("direct: islands past its limit are left to the iterative rows, and counted", "[physics][direct]")
{
  World large(load_scene("box-grid:nx=4,ny=8,nz=4"), direct()), small(load_scene("box-stack:n=30,height=3"), direct());
  double deepest = 0;
  for (int k = 0; k < 120; ++k) {
    large.step();
    deepest = std::max(deepest, large.statistics().max_penetration);
  }
  run(small, 3);
  INFO("box-grid 4 x 8 x 4: " << deepest << " m");
  CHECK(deepest < 0.02);
  CHECK(large.statistics().direct_left > 100);
  CHECK(small.statistics().direct_left == 0);
  CHECK(small.statistics().direct_islands == 10);
}

TEST_CASE("direct: a body that is not a number is taken out, and the stack beside it stands", "[physics][direct]")
{
  Scene scene = stack({1, 1, 1});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {3, 0.5f, 0});
  World world(scene, direct());
  run(world, 5);
  BodyState broken = world.bodies()[4];
  broken.linear_velocity[1] = std::nanf("");
  world.set_body_unchecked(4, broken);
  run(world, 30);
  REQUIRE(world.quarantined().size() == 1);
  CHECK(world.quarantined()[0].body == 4);
  CHECK(all_finite(world.bodies()));
  CHECK(world.bodies()[3].position[1] == Approx(2.5).margin(1e-4));
}

TEST_CASE("direct: boxes in one place come apart without flying off", "[physics][direct]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int k = 0; k < 6; ++k) add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.6f, 0});
  World world(scene, direct());
  double fastest = 0;
  for (int k = 0; k < 60; ++k) {
    world.step();
    for (const BodyState &state : world.bodies())
      fastest = std::max<double>(fastest, vector_of(state.linear_velocity).norm());
  }
  INFO("six boxes in one place: fastest " << fastest << " m/s");
  CHECK(all_finite(world.bodies()));
  CHECK(fastest < 20);
}

TEST_CASE("direct: a box jammed between two walls is gripped, and comes loose gently", "[physics][direct]")
{
  const float friction = GENERATE(0.0f, 0.5f);
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = friction;
  add_body(scene, BodyType::fixed, box_shape(0.5f, 2, 2), {-0.98f, 0, 0});
  add_body(scene, BodyType::kinematic, box_shape(0.5f, 2, 2), {0.97f, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}).mass = 1;
  Settings settings = direct();
  settings.events = true;
  World world(scene, settings);
  double largest = 0;
  for (int k = 0; k < 30; ++k) {
    world.step();
    for (const ContactEvent &event : world.contact_events()) largest = std::max<double>(largest, event.impulse);
  }
  CAPTURE(friction);
  INFO("largest impulse " << largest << " N s");
  /* A substep gives at most a hundred times the speed at which the overlap parts, which is at most the push speed. */
  CHECK(largest > 0);
  CHECK(largest < 4 * 100 * settings.push_speed);
  if (friction > 0) CHECK(world.bodies()[2].position[1] == Approx(0).margin(1e-3));
  else CHECK(world.bodies()[2].position[1] == Approx(-5 * 0.25).epsilon(0.05));
  BodyState wall = world.bodies()[1];
  wall.position[0] += 10;
  world.set_body(1, wall);
  world.step();
  CHECK(std::abs(world.bodies()[2].linear_velocity[0]) < 1e-3);
}

TEST_CASE("direct: jaws that close slowly grip a box", "[physics][direct]")
{
  const float speed = GENERATE(0.001f, 0.01f, 0.1f);
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0.5f;
  for (const float side : {-1.0f, 1.0f})
    add_body(scene, BodyType::kinematic, box_shape(0.5f, 2, 2), {side, 0, 0}).linear_velocity = {-side * speed, 0, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}).mass = 1;
  World world(scene, direct());
  run(world, 60);
  CAPTURE(speed);
  CHECK(world.bodies()[2].position[1] == Approx(0).margin(0.01));
}

TEST_CASE("direct: free fall follows the parabola", "[physics][direct]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 100, 0}).linear_velocity = {1, 2, 0};
  World world(scene, direct());
  run(world, 60);
  CHECK(world.bodies()[0].position[1] == Approx(100 + 2 - 5).epsilon(1e-6));
  CHECK(world.bodies()[0].position[0] == Approx(1).epsilon(1e-6));
}

TEST_CASE("direct: a box on an incline slips past atan mu, and slides as theory says", "[physics][direct]")
{
  Scene scene = empty_scene();
  const double mu = 0.5;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = float(mu);
  std::vector<double> angles;
  for (const double degrees : {-2.0, -0.5, 0.5, 2.0}) {
    const double angle = std::atan(mu) + degrees * radians;
    const Quat tilt = turn_about({0, 0, 1}, angle);
    const float z = 3.0f * float(angles.size());
    add_body(scene, BodyType::fixed, box_shape(10, 0.5f, 0.6f), {0, 0, z}).orientation = tilt;
    const Vector up(-std::sin(angle), std::cos(angle), 0);
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.15f, 0.5f), point_of(0.65 * up + Vector(0, 0, z)))
        .orientation = tilt;
    angles.push_back(angle);
  }
  World world(scene, direct());
  run(world, 60);
  const std::vector<BodyState> now = world.bodies();
  for (size_t k = 0; k < angles.size(); ++k) {
    const double slid = (vector_of(now[2 * k + 1].position) - vector_of(scene.bodies[2 * k + 1].position)).norm();
    const double expected = 0.5 * gravity * (std::sin(angles[k]) - mu * std::cos(angles[k]));
    CAPTURE(k, slid, expected);
    if (expected < 0) CHECK(slid < 1e-4);
    else CHECK(slid == Approx(expected).epsilon(0.02).margin(0.002));
  }
}

TEST_CASE("direct: a ball and a box that lands flat bounce to e^2 of their height", "[physics][direct]")
{
  Scene scene = empty_scene();
  scene.materials[0].restitution = 0.5f;
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {0, 2.25f, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.25f, 0.3f), {3, 2.25f, 0});
  World world(scene, direct());
  double rebound[2] = {0, 0};
  for (int k = 0; k < 60; ++k) {
    world.step();
    for (size_t i : {0u, 1u}) {
      const BodyState state = world.bodies()[i + 1];
      const double speed = state.linear_velocity[1];
      if (rebound[i] == 0 && speed > 0) rebound[i] = state.position[1] - 0.25 + speed * speed / (2 * gravity);
    }
  }
  for (const double height : rebound) CHECK(height == Approx(0.25 * 2).epsilon(0.01));
  CHECK(vector_of(world.bodies()[2].angular_velocity).norm() < 1e-4);
}

TEST_CASE("direct: the middle ball of three at rest passes on what the first brings, if e is 1 and they are apart",
          "[physics][direct]")
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = 1;
  for (const float x : {-2.0f, 0.0f, 1.5f}) add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {x, 0, 0});
  scene.bodies[0].linear_velocity = {3, 0, 0};
  World world(scene, direct());
  run(world, 120);
  CHECK(std::abs(world.bodies()[0].linear_velocity[0]) < 1e-5);
  CHECK(std::abs(world.bodies()[1].linear_velocity[0]) < 1e-5);
  CHECK(world.bodies()[2].linear_velocity[0] == Approx(3).epsilon(1e-5));
}

TEST_CASE("direct: a closed system keeps its momentum and gains no energy", "[physics][direct]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f);
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = friction;
  scene.materials[0].restitution = restitution;
  Random random(5);
  for (int i = 0; i < 8; ++i) {
    const Vector place(1.4 * (i % 2) - 0.7, 1.4 * (i / 2 % 2) - 0.7, 1.4 * (i / 4) - 0.7);
    const float size = float(random.uniform(0.25, 0.4));
    Body &body = add_body(scene, BodyType::dynamic,
                          i % 2 ? sphere_shape(size) : box_shape(size, 0.7f * size, 1.2f * size), point_of(place));
    body.orientation = random.orientation();
    body.mass = float(random.uniform(0.5, 4));
    body.linear_velocity = vec3_of(-1.5 * place);
    body.angular_velocity = vec3_of(Vector(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
  }
  World world(scene, direct(), Placement{"tbb:threads=1", {}, false});
  const Momentum start = momentum_of(world);
  const double energy_at_start = world.statistics().kinetic_energy;
  double energy = energy_at_start, growth = 0, linear = 0, angular = 0;
  uint32_t contacts = 0, stalled = 0;
  for (int k = 0; k < 90; ++k) {
    world.step();
    const Momentum now = momentum_of(world);
    const Statistics statistics = world.statistics();
    linear = std::max(linear, (now.linear - start.linear).norm() / start.linear_scale);
    angular = std::max(angular, (now.angular - start.angular).norm() / start.angular_scale);
    growth = std::max(growth, (statistics.kinetic_energy - energy) / energy_at_start);
    energy = statistics.kinetic_energy;
    contacts += statistics.contacts;
    stalled += statistics.direct_stalled;
  }
  INFO("friction " << friction << ", restitution " << restitution << ": momentum " << linear << ", angular " << angular
                   << ", energy grown " << growth << ", contacts " << contacts << ", stalled " << stalled);
  CHECK(contacts > 20);
  CHECK(linear < 1e-5);
  CHECK(angular < 1e-5);
  CHECK(growth < (restitution == 0 ? 1e-4 : 0.02));
}
