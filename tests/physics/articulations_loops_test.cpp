/* Joints that hold links from outside of their trees: loops, bodies and other trees that hang on links, against closed
 * forms and against the same machines in maximal coordinates. */
#include <numbers>

#include "tests/catch.h"
#include "tests/parity/articulations.h"
#include "tests/physics/articulate.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement on_one{"serial", {}, false};

Body &add_loose_box(Scene &scene, const Vec3 &half, const Vector &at, float mass)
{
  Body &body = add_body(scene, BodyType::dynamic, box_shape(half[0], half[1], half[2]), point_of(at));
  body.filter_mask = 0;
  body.mass = mass;
  return body;
}

/* Two rods of 1 m that hang side by side, and a beam between their lower ends, which stays level; let go at an angle.
 * The second rod's hinge is the last joint. */
Scene parallelogram(double angle)
{
  Scene scene = empty_scene({0, -10, 0});
  const Vector way(std::sin(angle), -std::cos(angle), 0), span(2, 0, 0);
  const auto add_rod = [&](const Vector &top) {
    add_loose_box(scene, {0.02f, 0.5f, 0.02f}, top + 0.5 * way, 1).orientation =
        quat_of(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector::UnitZ())));
  };
  add_rod(Vector::Zero());
  add_loose_box(scene, {1, 0.02f, 0.02f}, 0.5 * span + way, 3);
  add_rod(span);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  connect(scene, JointType::hinge, 0, 1, way, Vector::UnitZ());
  connect(scene, JointType::hinge, 1, 2, span + way, Vector::UnitZ());
  articulate(scene);
  connect(scene, JointType::hinge, no_body, 2, span, Vector::UnitZ());
  return scene;
}

/* A ring of boxes on balls, in the plane y = 0. The last joint closes it. */
Scene ring(uint32_t links)
{
  Scene scene = empty_scene({0, 0, 0});
  const double turn = 2 * std::numbers::pi / links, radius = 0.25 / std::tan(turn / 2);
  const auto place = [&](double k, double r) { return Vector(r * std::cos(k * turn), 0, r * std::sin(k * turn)); };
  for (uint32_t k = 0; k < links; ++k)
    add_loose_box(scene, {0.05f, 0.05f, 0.2f}, place(k, radius), 1).orientation =
        quat_of(Eigen::Quaterniond(Eigen::AngleAxisd(-k * turn, Vector::UnitY())));
  for (uint32_t k = 0; k < links; ++k)
    connect(scene, JointType::ball, k, (k + 1) % links, place(k + 0.5, std::hypot(radius, 0.25)));
  return scene;
}

double kinetic_energy(World &world)
{
  world.step();
  return world.statistics().kinetic_energy;
}

} // namespace

TEST_CASE("a parallelogram whose loop a joint closes swings with the period of its closed form", "[articulations]")
{
  const double angle = 0.2, gravity = 10;
  World world(parallelogram(angle), settings_with(1.0 / 240), on_one);
  const double moment_of_rod = (0.02 * 0.02 + 0.5 * 0.5) / 3 + 0.25; /* about its end */
  const double inertia = 2 * moment_of_rod + 3, pull = (2 * 0.5 + 3) * gravity;
  const double quarter_wave = angle / 4; /* of the elliptic integral, as far as matters */
  const double expected = 2 * std::numbers::pi * std::sqrt(inertia / pull) * (1 + quarter_wave * quarter_wave);
  double turned = 0, crossing = 0;
  std::vector<double> crossings;
  double before = angle;
  for (int k = 1; k < 1500; ++k) {
    world.step();
    const Vector at = vector_of(world.precise_bodies()[1].position) - Vector(1, 0, 0);
    turned = std::atan2(at.x(), -at.y());
    if ((turned > 0) != (before > 0)) crossings.push_back((k - turned / (turned - before)) / 240);
    before = turned;
    crossing = std::max(crossing, std::abs(axes_of(world.bodies()[1].orientation)(1, 0))); /* the beam stays level */
    CHECK(open_joints(world).max_distance < 1e-4);
  }
  REQUIRE(crossings.size() > 3);
  const double period = 2 * (crossings.back() - crossings.front()) / double(crossings.size() - 1);
  CHECK(std::abs(period / expected - 1) < 2e-3);
  CHECK(crossing < 1e-3);
}

TEST_CASE("a free ring that a ball joint closes keeps momentum and energy, and moves as one without a tree",
          "[articulations]")
{
  for (const uint32_t links : {4u, 9u}) {
    CAPTURE(links);
    Scene apart = ring(links), closed = apart;
    const Joint last = closed.joints.back();
    closed.joints.pop_back();
    articulate(closed, 0);
    closed.joints.push_back(last);
    for (Scene *each : {&apart, &closed})
      for (Body &body : each->bodies) {
        body.angular_velocity = {0, 3, 0};
        body.linear_velocity = vec3_of(Vector(0, 3, 0).cross(vector_of(body.position)));
      }
    World maximal(apart, settings_with(1.0 / 240, 8), on_one), world(closed, settings_with(1.0 / 240, 8), on_one);
    for (int k = 0; k < 10; ++k)
      for (World *each : {&world, &maximal}) {
        each->add_force(each->body_ids()[2], {{10, 30, 5}, {}});
        each->step();
      }
    const double energy = kinetic_energy(world);
    kinetic_energy(maximal);
    const Momentum before = momentum_of(world);
    for (int k = 0; k < 240; ++k) {
      world.step();
      maximal.step();
      CHECK(open_joints(world).max_distance < 2e-4);
    }
    const Momentum after = momentum_of(world);
    CHECK((after.linear - before.linear).norm() < 1e-4 * before.angular_scale);
    CHECK((after.angular - before.angular).norm() < 1e-3 * before.angular_scale);
    CHECK(std::abs(world.statistics().kinetic_energy / energy - 1) < 0.02);
    for (uint32_t k = 0; k < links; ++k) {
      const auto one = world.precise_bodies()[k], other = maximal.precise_bodies()[k];
      CHECK((vector_of(one.position) - vector_of(other.position)).norm() < 0.02);
    }
  }
}

TEST_CASE("a weight hangs on a link by a joint, a thousand times as heavy as the chain", "[articulations]")
{
  Scene scene = empty_scene({0, -10, 0});
  for (int k = 0; k < 5; ++k) {
    add_loose_box(scene, {0.05f, 0.25f, 0.05f}, {0, -0.25 - 0.5 * k, 0}, 1);
    connect(scene, JointType::ball, k == 0 ? no_body : uint32_t(k - 1), uint32_t(k), {0, -0.5 * k, 0});
  }
  articulate(scene);
  add_loose_box(scene, {0.3f, 0.3f, 0.3f}, {0, -2.8, 0}, 1000);
  connect(scene, JointType::ball, 4, 5, {0, -2.5, 0});
  World world(scene, {}, on_one);
  run(world, 240);
  CHECK(open_joints(world).max_distance < 2e-3);
  CHECK(fastest(world) < 1e-2);
  CHECK(std::abs(world.precise_bodies()[5].position[1] + 2.8) < 2e-3);
  const std::array last{world.joint_ids()[5]};
  CHECK(std::abs(vector_of(world.read_joints(last)[0].force).norm() / 1e4 - 1) < 1e-2);
}

TEST_CASE("joints of links come, break and go while a world runs", "[articulations]")
{
  Scene scene = empty_scene({0, -10, 0});
  for (int tree = 0; tree < 2; ++tree)
    for (int k = 0; k < 3; ++k) {
      const auto own = uint32_t(3 * tree + k);
      add_loose_box(scene, {0.2f, 0.05f, 0.05f}, {0.4 * k, 2.0 - tree, 0}, 1);
      if (k > 0) connect(scene, JointType::hinge, own - 1, own, {0.4 * k - 0.2, 2.0 - tree, 0}, Vector::UnitZ());
    }
  scene.articulations = {{"upper", {0, 1}, 0, {}}, {"lower", {2, 3}, 3, {}}};
  connect(scene, JointType::fixed, no_body, 0, {-0.2, 2, 0});
  World world(scene, {}, on_one);
  Scene joined = scene;
  Joint rope = connect(joined, JointType::ball, 2, 3, {0.8, 1.5, 0});
  const JointId hangs = world.create_joint(rope);
  run(world, 120);
  CHECK(open_joints(world).max_distance < 5e-3);
  CHECK(world.precise_bodies()[3].position[1] > -1.5); /* the lower tree hangs on the upper one */
  World restored(world.save(), on_one);
  CHECK(restored.state_hash() == world.state_hash());
  world.destroy_joint(hangs);
  const double height = world.precise_bodies()[5].position[1];
  run(world, 60);
  CHECK(world.precise_bodies()[5].position[1] < height - 4);
  rope.break_force = 1; /* the lower tree weighs 30 N */
  restored.destroy_joint(restored.joint_ids().back());
  restored.create_joint(rope);
  restored.step();
  REQUIRE(restored.joint_breaks().size() == 1);
  run(restored, 10);
  CHECK(std::isfinite(restored.precise_bodies()[5].position[1]));
}

TEST_CASE("loops that contradict each other pull, and neither explode nor give way to what is not finite",
          "[articulations]")
{
  for (const JointType type : {JointType::ball, JointType::fixed, JointType::hinge, JointType::universal})
    for (const double gap : {0.01, 0.5, 10.0, -0.01, -0.5}) { /* below 0: hinges about two axes in turn */
      Scene scene = empty_scene({0, -10, 0});
      for (uint32_t k = 0; k < 6; ++k) {
        add_loose_box(scene, {0.2f, 0.05f, 0.05f}, {0.4 * k, 2, 0}, 1);
        connect(scene, gap < 0 || k % 2 ? JointType::hinge : JointType::ball, k > 0 ? k - 1 : no_body, k,
                {0.4 * k - 0.2, 2, 0}, gap < 0 && k % 2 ? Vector::UnitY() : Vector::UnitZ());
      }
      articulate(scene);
      connect(scene, type, no_body, 5, {2.2, 2, 0}).position_a = {2.2 + std::abs(gap), 2, gap / 2};
      connect(scene, type, 1, 4, {0.4, 2, 0}).position_b = {0, 0, 0};
      World world(scene, {}, on_one);
      for (int k = 0; k < 300; ++k) {
        world.step();
        CHECK(fastest(world) < 50);
      }
      CHECK(world.quarantined().empty());
    }
}

TEST_CASE("seventy bodies hang on one link, more than there are colours", "[articulations]")
{
  Scene scene = empty_scene({0, -10, 0});
  add_loose_box(scene, {0.5f, 0.1f, 0.5f}, {0, 0, 0}, 10);
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  articulate(scene);
  for (uint32_t k = 0; k < 70; ++k) {
    const Vector at(0.08 * (k % 10) - 0.4, -0.3, 0.1 * int(k / 10) - 0.3);
    add_loose_box(scene, {0.02f, 0.1f, 0.02f}, at, 0.5f);
    connect(scene, JointType::ball, 0, k + 1, at + Vector(0, 0.1, 0));
  }
  World world(scene, {}, on_one);
  run(world, 60);
  CHECK(open_joints(world).max_distance < 1e-4);
  CHECK(fastest(world) < 1e-2);
}

TEST_CASE("a tree in quarantine holds what hangs on its links where they are", "[articulations]")
{
  Scene scene = empty_scene({0, -10, 0});
  for (uint32_t k = 0; k < 3; ++k) {
    add_loose_box(scene, {0.1f, 0.2f, 0.1f}, {0, -0.4 * k, 0}, 1);
    if (k > 0) connect(scene, JointType::ball, k - 1, k, {0, 0.2 - 0.4 * k, 0});
  }
  scene.articulations = {{"pair", {0}, 0, {}}};
  World world(scene, {}, on_one);
  run(world, 5);
  world.set_velocity(world.body_ids()[0], {{3e38f, 0, 0}, {0, 3e38f, 0}});
  run(world, 60);
  CHECK(world.quarantined().size() == 2);
  CHECK(std::isfinite(world.precise_bodies()[2].position[1]));
  CHECK(fastest(world) < 1e3);
}
