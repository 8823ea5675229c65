/* Joints at their limits: too many of them, far away, far apart, heavy on light, locked, driven. What they do then is
 * bounded: nothing is thrown away, and what can close closes. */
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement one_thread{"serial", {}, false};

double kinetic_of(World &world) { return world.statistics().kinetic_energy; }

/* Half an arm of each link beyond its centre, links of a metre along x from the origin. */
Scene chain(JointType type, uint32_t links, double last_mass, const Vector &axis)
{
  Scene scene = empty_scene();
  for (uint32_t i = 0; i < links; ++i) {
    Body &link = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.2f), {0.5 + i, 0, 0});
    if (i + 1 == links) link.mass = float(last_mass);
    connect(scene, type, i == 0 ? no_body : i - 1, i, {double(i), 0, 0}, axis);
  }
  return scene;
}

} // namespace

TEST_CASE("a table whose four legs are fixed to the plate and the floor stands still", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.6f), {0, 1.05, 0}).mass = 20;
  for (const double x : {-0.9, 0.9})
    for (const double z : {-0.5, 0.5}) {
      add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.5f, 0.05f), {x, 0.5, z});
      const auto leg = uint32_t(scene.bodies.size() - 1);
      connect(scene, JointType::fixed, 1, leg, {x, 1, z});
      connect(scene, JointType::fixed, 0, leg, {x, 0, z});
    }
  World world(scene, {}, one_thread);
  run(world, 300);
  const PreciseBodies bodies = world.precise_bodies();
  /* The weight of the plate and the legs stretches four pairs of joints, as an acceleration of what a joint moves: a
   * leg of 1 kg, and a corner of the plate, with the moments of the plate about x and z. */
  const double corner = 1.0 / 20 + 0.5 * 0.5 / (20 * 0.36 / 3) + 0.9 * 0.9 / (20 * 1.0 / 3);
  const double open = (20.0 / 4 + 1) * gravity * (1 + corner) * Softness(Settings{}).stretch;
  CHECK(bodies[1].position[1] == Approx(1.05).margin(2 * open));
  CHECK(std::abs(bodies[1].position[0]) < 1e-4);
  CHECK(fastest(world) < 1e-3);
  CHECK(open_joints(world).max_distance < open);
  CHECK(open_joints(world).max_angle < 1e-3);
}

TEST_CASE("a body that carries a thousand others on ball joints keeps them", "[physics]")
{
  Scene scene = empty_scene();
  const uint32_t balls = 1000;
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 0, 0}).mass = 2000;
  connect(scene, JointType::ball, no_body, 0, {0, 0, 0});
  Random random(4);
  for (uint32_t i = 0; i < balls; ++i) {
    const Vector way = direction(random);
    add_body(scene, BodyType::dynamic, sphere_shape(0.1f), point_of(1.5 * way)).filter_mask = 0;
    connect(scene, JointType::ball, 0, 1 + i, way);
  }
  const double start = [&] {
    World world(scene, {}, one_thread);
    return conserved_quantities(scene, world.precise_bodies()).energy();
  }();
  World world(scene, {}, one_thread);
  double most = start;
  for (int step = 0; step < 120; ++step) {
    world.step();
    most = std::max(most, conserved_quantities(scene, world.precise_bodies()).energy());
  }
  CHECK(all_finite(world.bodies()));
  /* Balls swing on arms of half a metre; Euler's energy swings by half of w h, here a hundredth, of the work. */
  CHECK(most - start < 0.01 * balls * gravity * 0.5);
  CHECK(open_joints(world).max_distance < 0.02);
}

/* A body with many others of its mass on ball joints, in free space, each with a velocity of 1 m/s of its own. */
static Scene star(uint32_t joints, double arm)
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  Random random(7);
  add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.4f), {0, 0, 0}).filter_mask = 0;
  for (uint32_t i = 1; i <= joints; ++i) {
    const Vector way = direction(random);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.4f), point_of(2 * arm * way));
    body.filter_mask = 0;
    body.linear_velocity = vec3_of(direction(random));
    connect(scene, JointType::ball, 0, i, arm * way, direction(random));
  }
  return scene;
}

TEST_CASE("a star of many bodies on one of their mass gains no energy and keeps its momentum", "[physics]")
{
  const uint32_t joints = GENERATE(6u, 7u, 8u, 9u, 12u, 16u, 32u, 60u, 200u);
  const bool anchored = GENERATE(false, true);
  Scene scene = star(joints, GENERATE(0.3, 2.0));
  if (anchored) connect(scene, JointType::ball, no_body, 0, {0, 0.1, 0});
  World world(scene, {}, one_thread);
  const Momentum start = momentum_of(world);
  const double energy = conserved_quantities(scene, world.precise_bodies()).energy();
  for (int step = 0; step < 240; ++step) {
    world.step();
    /* Joints take energy out of velocities that they do not allow, and add none. */
    REQUIRE(conserved_quantities(scene, world.precise_bodies()).energy() < energy);
  }
  /* Each of n joints takes 2 / n of an error in a pass, so what the turning opens grows as n. */
  CHECK(open_joints(world).max_distance < 0.0005 * joints);
  if (anchored) return;
  const Momentum end = momentum_of(world);
  CHECK((end.linear - start.linear).norm() < 1e-5 * joints);
  CHECK((end.angular - start.angular).norm() < 1e-4 * start.angular.norm());
}

/* Others of 1 kg hang on a ball of this mass and radius, each with a velocity of its own. */
static Scene star_on_ball(JointType type, uint32_t joints, double mass, double radius)
{
  Scene scene = empty_scene({0, 0, 0});
  Random random(joints);
  add_body(scene, BodyType::dynamic, sphere_shape(float(radius)), {0, 0, 0}).mass = float(mass);
  for (uint32_t i = 1; i <= joints; ++i) {
    const Vector way = direction(random);
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), point_of(0.5 * way));
    body.filter_mask = 0;
    body.linear_velocity = vec3_of(0.5 * direction(random));
    body.angular_velocity = vec3_of(0.5 * direction(random));
    connect(scene, type, 0, i, 0.3 * way, way);
  }
  return scene;
}

TEST_CASE("a star on a light or small body gains no energy, however few or many it has", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  const uint32_t joints = GENERATE(3u, 4u, 5u, 6u, 7u, 10u, 30u);
  for (const auto &[mass, radius] : {std::pair(1.0, 0.3), std::pair(0.1, 0.3), std::pair(1.0, 0.08)}) {
    CAPTURE(name_of_type(type), joints, mass, radius);
    const Scene scene = star_on_ball(type, joints, mass, radius);
    World world(scene, {}, one_thread);
    const double energy = conserved_quantities(scene, world.precise_bodies()).energy();
    const Momentum start = momentum_of(world);
    for (int step = 0; step < 180; ++step) {
      world.step();
      REQUIRE(conserved_quantities(scene, world.precise_bodies()).energy() < 1.001 * energy);
    }
    const Momentum end = momentum_of(world);
    CHECK((end.linear - start.linear).norm() < 1e-5 * start.linear_scale);
    CHECK((end.angular - start.angular).norm() < 1e-4 * start.angular_scale);
  }
}

/* Arms of 1 kg and a metre in a half circle beside a ball of 0.3 m that is fixed to the world. */
static Scene laden_hub(JointType type, uint32_t arms, double mass)
{
  Scene scene = empty_scene();
  Body &hub = add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {0, 0, 0});
  hub.mass = float(mass);
  hub.filter_mask = 0;
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  for (uint32_t i = 1; i <= arms; ++i) {
    const double angle = M_PI * i / arms;
    const Vector at(std::cos(angle), 0, std::sin(angle));
    Body &arm = add_body(scene, BodyType::dynamic, sphere_shape(0.3f), point_of(at));
    arm.mass = 1;
    arm.filter_mask = 0;
    connect(scene, type, 0, i, at);
  }
  return scene;
}

TEST_CASE("arms that are heavier than the hub which carries them come to rest", "[physics]")
{
  const JointType type = GENERATE(JointType::ball, JointType::fixed, JointType::universal);
  const uint32_t arms = GENERATE(3u, 4u, 6u, 12u, 30u);
  const double mass = GENERATE(8.0, 4.0, 2.0, 1.0, 0.5);
  CAPTURE(name_of_type(type), arms, mass);
  Settings settings;
  settings.joint_hertz = GENERATE(60.0f, 1000.0f);
  World world(laden_hub(type, arms, mass), settings, one_thread);
  double fastest = 0;
  for (int step = 0; step < 600; ++step) {
    world.step();
    fastest = std::max(fastest, kinetic_of(world));
  }
  /* Arms have no more energy than they get while joints give way by a tenth of a metre, and lose it. */
  const double work = arms * gravity * 0.1;
  CHECK(fastest < work);
  CHECK(kinetic_of(world) < 0.01 * work);
}

/* Thin rods that are welded to a ball by their ends, in directions all around it; the world holds the ball by welds. */
static Scene star_of_rods(uint32_t rods, double mass, float radius, uint32_t welds)
{
  Scene scene = empty_scene({0, welds > 0 ? -float(gravity) : 0.0f, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(radius), {0, 0, 0}).mass = 1;
  for (uint32_t i = 0; i < welds; ++i) connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  for (uint32_t i = 1; i <= rods; ++i) {
    const double angle = 2 * M_PI * i / rods;
    const Vector way(std::cos(angle), 0, std::sin(angle));
    Body &rod = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), point_of((radius + 0.5) * way));
    rod.orientation = turn_about(Vector::UnitY(), -angle);
    rod.mass = float(mass);
    connect(scene, JointType::fixed, 0, i, radius * way);
  }
  for (Body &body : scene.bodies) body.filter_mask = 0;
  return scene;
}

TEST_CASE("thin rods that are welded to a light ball stay at rest", "[physics]")
{
  const uint32_t rods = GENERATE(3u, 4u, 5u, 6u);
  const float radius = GENERATE(0.05f, 0.1f, 0.2f);
  const double mass = GENERATE(0.02, 0.1, 0.25, 0.5);
  CAPTURE(rods, radius, mass);
  Scene scene = star_of_rods(rods, mass, radius, 0);
  scene.bodies.back().angular_velocity = {0, 0, 0.001f};
  World world(scene, {}, one_thread);
  const double start = kinetic_of(world);
  for (int step = 0; step < 600; ++step) world.step();
  CHECK(kinetic_of(world) < start);
}

TEST_CASE("thin rods on a ball that the world holds come to rest", "[physics]")
{
  const uint32_t rods = GENERATE(2u, 3u, 4u, 6u), welds = GENERATE(1u, 2u);
  const float radius = GENERATE(0.1f, 0.3f);
  const double mass = GENERATE(0.25, 1.0, 2.0);
  CAPTURE(rods, welds, radius, mass);
  World world(star_of_rods(rods, mass, radius, welds), {}, one_thread);
  double fastest = 0;
  for (int step = 0; step < 600; ++step) {
    world.step();
    fastest = std::max(fastest, kinetic_of(world));
  }
  const double work = rods * mass * gravity * 0.1;
  CHECK(fastest < work);
  CHECK(kinetic_of(world) < 0.001 * work);
}

TEST_CASE("joints whose frames begin ten metres apart close, and throw nothing", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  const bool to_world = GENERATE(false, true);
  Random random(6);
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 2; ++i) {
    Body &body = add_body(scene, i == 0 && to_world ? BodyType::fixed : BodyType::dynamic, box_shape(0.5f, 0.3f, 0.4f),
                          {0, 0, 0});
    body.orientation = any_turn(random);
    body.filter_mask = 0;
  }
  connect(scene, type, 0, 1, {0.5, 0.2, 0.1}, {1, 1, 1});
  scene.bodies[1].position = {6, -7, 4};
  scene.bodies[1].orientation = any_turn(random);
  World world(scene, {}, one_thread);
  const JointErrorSummary before = open_joints(world);
  double most = 0;
  for (int step = 0; step < 600; ++step) {
    world.step();
    most = std::max(most, kinetic_of(world));
  }
  const JointErrorSummary after = open_joints(world);
  CAPTURE(name_of_type(type), to_world, before.max_distance, before.max_angle, after.max_distance, after.max_angle);
  /* What goes on turning loads the joint with w^2 at the distance of the bodies. */
  const std::vector<BodyState> states = world.bodies();
  double spin = 0;
  for (const BodyState &state : states) spin = std::max(spin, vector_of(state.angular_velocity).norm());
  const double apart = std::max(1.0, (vector_of(states[1].position) - vector_of(states[0].position)).norm());
  const double most_open = spin * spin * apart * Softness(Settings{}).open + 1e-5;
  CHECK(after.max_distance < most_open);
  CHECK(after.max_angle < most_open);
  /* Frames close with 10 m/s and 10 rad/s at most, so no body of 1 kg gets more. */
  CHECK(most < 2 * 0.5 * (10 * 10 + 10 * 10));
}

TEST_CASE("a joint to the world holds a thousand kilometres away", "[physics]")
{
  const JointType type = GENERATE(JointType::ball, JointType::hinge, JointType::fixed);
  Scene near = empty_scene(), far = empty_scene();
  const Vector there(1e6, -1e6, 1e6);
  for (Scene *scene : {&near, &far}) {
    const Vector at = scene == &far ? there : Vector(Vector::Zero());
    add_body(*scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.2f), point_of(at + Vector(0.5, 0, 0)));
    connect(*scene, type, no_body, 0, at, Vector::UnitZ());
  }
  World here(near, {}, one_thread), world(far, {}, one_thread);
  run(here, 300);
  run(world, 300);
  const PreciseBodies one = here.precise_bodies(), other = world.precise_bodies();
  const double error = (Vector(other[0].position.data()) - there - Vector(one[0].position.data())).norm();
  CAPTURE(name_of_type(type), error);
  CHECK(error < 1e-3);
  CHECK(open_joints(world).max_distance < 1e-3);
}

TEST_CASE("a closed loop of four hinges moves as a parallelogram", "[physics]")
{
  Scene scene = empty_scene();
  /* Two cranks of 1 m stand 2 m apart on hinges to the world; a bar of 2 m joins their ends. */
  add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.5f, 0.05f), {0, 0.5, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.5f, 0.05f), {2, 0.5, 0});
  add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.05f), {1, 1, 0});
  for (Body &body : scene.bodies) body.filter_mask = 0;
  connect(scene, JointType::hinge, no_body, 0, {0, 0, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, no_body, 1, {2, 0, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, 0, 2, {0, 1, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, 1, 2, {2, 1, 0}, Vector::UnitZ());
  scene.bodies[0].angular_velocity = scene.bodies[1].angular_velocity = {0, 0, -1};
  scene.bodies[0].linear_velocity = scene.bodies[1].linear_velocity = {0.5f, 0, 0};
  scene.bodies[2].linear_velocity = {1, 0, 0};
  World world(scene, {}, one_thread);
  double tilt = 0, open = 0, lowest = 1;
  for (int step = 0; step < 300; ++step) {
    world.step();
    const PreciseBodies bodies = world.precise_bodies();
    tilt = std::max(tilt, angle_between({0, 0, 0, 1}, bodies[2].orientation));
    open = std::max(open, open_joints(world).max_distance);
    lowest = std::min(lowest, bodies[2].position[1]);
  }
  CHECK(lowest < -0.99); /* it has swung through */
  CHECK(tilt < 0.01);
  CHECK(open < 0.01);
}

TEST_CASE("a chain with a hundred times the mass at its end holds", "[physics]")
{
  const JointType type = GENERATE(JointType::ball, JointType::hinge);
  const Scene scene = chain(type, 5, 100, Vector::UnitZ());
  World world(scene, {}, one_thread);
  double open = 0, most = 0;
  const double start = conserved_quantities(scene, world.precise_bodies()).energy();
  for (int step = 0; step < 600; ++step) {
    world.step();
    open = std::max(open, open_joints(world).max_distance);
    most = std::max(most, conserved_quantities(scene, world.precise_bodies()).energy() - start);
  }
  CHECK(all_finite(world.bodies()));
  CHECK(most < 0.01 * 100 * gravity * 5); /* half of w h of the work, as of any pendulum */
  /* Links of 1 kg under five times the weight of the end, which swings as a pendulum. */
  CHECK(open < 5 * 100 * gravity * Softness(Settings{}).open);
}

TEST_CASE("a chain with a thousand times the mass at its end stretches by less than its length, and gains no energy",
          "[physics]")
{
  /* Hinges in a row under that load need more than 4 substeps (docs/joints.md). */
  const auto [type, substeps] =
      GENERATE(std::pair(JointType::ball, 4u), std::pair(JointType::fixed, 4u), std::pair(JointType::hinge, 16u));
  const Scene scene = chain(type, 5, 1000, Vector::UnitZ());
  Settings settings;
  settings.substeps = substeps;
  World world(scene, settings, one_thread);
  const double start = conserved_quantities(scene, world.precise_bodies()).energy();
  for (int step = 0; step < 600; ++step) {
    world.step();
    REQUIRE(conserved_quantities(scene, world.precise_bodies()).energy() < start + 0.01 * 1000 * gravity * 5);
  }
  CHECK(all_finite(world.bodies()));
  CHECK(open_joints(world).max_distance < 0.5);
}

TEST_CASE("steps of a tenth of a second keep a chain together", "[physics]")
{
  const Scene scene = chain(GENERATE(JointType::ball, JointType::hinge), 8, 1, Vector::UnitZ());
  World world(scene, settings_with(0.1), one_thread);
  const double start = conserved_quantities(scene, world.precise_bodies()).energy();
  double most = 0, open = 0;
  for (int step = 0; step < 200; ++step) {
    world.step();
    most = std::max(most, conserved_quantities(scene, world.precise_bodies()).energy() - start);
    open = std::max(open, open_joints(world).max_distance);
  }
  CHECK(all_finite(world.bodies()));
  /* Half of w h of the work, at w of the shortest pendulum of the chain. */
  CHECK(most < 0.5 * std::sqrt(gravity / 0.5) * 0.025 * 8 * gravity * 4);
  CHECK(open < 0.5);
}

TEST_CASE("a joint between bodies of infinite inertia and of locked axes gives no motion that they lack", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  Scene scene = empty_scene();
  Body &rigid = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.2f), {0, 0, 0});
  rigid.infinite_inertia = true;
  Body &locked = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.2f), {1.2, 0, 0});
  locked.linear_locks = {false, true, true};
  locked.angular_locks = {true, false, true};
  Body &still = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.2f), {2.4, 0, 0});
  still.linear_locks = still.angular_locks = {true, true, true};
  Body &last = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.2f), {3.6, 0, 0});
  last.angular_velocity = {1, 2, 3};
  for (uint32_t i = 0; i < 3; ++i) connect(scene, type, i, i + 1, {1.2 * i + 0.6, 0, 0}, {1, 1, 0});
  World world(scene, {}, one_thread);
  run(world, 200);
  const std::vector<BodyState> states = world.bodies();
  CAPTURE(name_of_type(type));
  REQUIRE(all_finite(states));
  CHECK(states[0].orientation == scene.bodies[0].orientation);
  CHECK((states[1].position[1] == 0 && states[1].position[2] == 0));
  CHECK((states[1].angular_velocity[0] == 0 && states[1].angular_velocity[2] == 0));
  CHECK((vector_of(states[2].position) - vector_of(scene.bodies[2].position)).norm() < 1e-12); /* two floats */
  CHECK(states[2].orientation == scene.bodies[2].orientation);
  CHECK(world.statistics().nonfinite == 0);
}

TEST_CASE("a kinematic body that moves takes along what is joined to it", "[physics]")
{
  const JointType type = GENERATE(JointType::ball, JointType::fixed, JointType::hinge);
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::kinematic, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0});
  Body &carried = add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {1, 0, 0});
  const Vector velocity(0.5, 1, -0.25), spin(0, 0, 2);
  scene.bodies[0].linear_velocity = vec3_of(velocity);
  scene.bodies[0].angular_velocity = vec3_of(spin);
  carried.linear_velocity = vec3_of(velocity + spin.cross(Vector(1, 0, 0)));
  carried.angular_velocity = vec3_of(spin);
  connect(scene, type, 0, 1, {0.5, 0, 0}, Vector::UnitY());
  World world(scene, {}, one_thread);
  double open = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    open = std::max(open, open_joints(world).max_distance);
  }
  const Vector at(world.precise_bodies()[0].position.data());
  CHECK((at - 5 * velocity).norm() < 1e-4);        /* as if nothing hung on it */
  CHECK(open < 2 * 2 * Softness(Settings{}).open); /* the load w^2 r */
}

TEST_CASE("a pair that rests on others rests with its joint closed", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {1.1, 0.5, 0});
  add_body(scene, BodyType::dynamic, box_shape(1, 0.2f, 0.4f), {0.55, 1.2, 0});
  connect(scene, type, 1, 2, {0.55, 0.5, 0}, Vector::UnitX());
  World world(scene, {}, one_thread);
  run(world, 300);
  CAPTURE(name_of_type(type));
  CHECK(fastest(world) < 1e-2);
  CHECK(open_joints(world).max_distance < 1e-3);
  CHECK(open_joints(world).max_angle < 1e-3);
  CHECK(world.bodies()[3].position[1] == Approx(1.2).margin(0.02));
}

/* A body in quarantine is at rest and is neither pushed nor pushes; what was joined to it goes on. */
TEST_CASE("a body that stops being finite takes no other along its joints", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  Scene scene = chain(type, 4, 1, Vector::UnitZ());
  World world(scene, {}, one_thread);
  run(world, 10);
  BodyState state = world.bodies()[2];
  state.linear_velocity = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  world.set_body_unchecked(2, state);
  run(world, 20);
  CAPTURE(name_of_type(type));
  CHECK(world.statistics().nonfinite == 1);
  REQUIRE(world.quarantined().size() >= 1);
  CHECK(world.quarantined().front().body == 2);
  for (const size_t i : {0u, 1u, 3u}) {
    const PreciseBodyState s = world.precise_bodies()[i];
    CHECK((std::isfinite(s.position[0]) && std::isfinite(s.linear_velocity[1])));
  }
}

/* An impulse of a limit acts along the axis about which its coordinate changes. Another axis would do work. */
TEST_CASE("a chain of balls with limits of all three rotations gains no energy", "[physics]")
{
  const uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u);
  const float reach = GENERATE(0.3f, 0.8f, 1.3f);
  CAPTURE(seed, reach);
  Scene scene = chain(JointType::ball, 5, 1, Vector::UnitX());
  scene.gravity = {0, 0, 0};
  Random random(seed);
  for (Body &link : scene.bodies) {
    link.filter_mask = 0;
    link.angular_velocity = vec3_of(3 * direction(random));
  }
  for (Joint &joint : scene.joints) joint.rotations.fill({.lower = -reach, .upper = reach});
  World world(scene, {}, one_thread);
  world.step(); /* joints take what they do not allow */
  const double start = conserved_quantities(scene, world.precise_bodies()).energy();
  double most = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    most = std::max(most, conserved_quantities(scene, world.precise_bodies()).energy());
  }
  CHECK(most < 1.001 * start);
}
