/* Contacts within one tree, and of a tree with the ground alone, which are solved by its table of paths
 * (shared/articulations/path.h): carts on rails that meet, against the closed forms of bodies of their masses, and
 * chains of as many freedoms as have a table and of one more, which have none. */
#include "tests/catch.h"
#include "tests/physics/articulate.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement one_thread{"serial", {}, false};
constexpr double base_mass = 10;

struct Cart {
  double x, mass, speed;
  JointType joint = JointType::slider; /* on the base */
};

Scene without_friction(float restitution)
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  scene.materials[0].restitution = restitution;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  return scene;
}

/* A free base of 10 kg below cubes of 0.2 m, which slide along x without friction or are a part of it. */
Scene carts_on_base(const std::vector<Cart> &carts, float restitution)
{
  Scene scene = without_friction(restitution);
  add_body(scene, BodyType::dynamic, box_shape(2, 0.1f, 0.5f), {0, 0, 0}).mass = float(base_mass);
  for (const Cart &cart : carts) {
    const auto body = uint32_t(scene.bodies.size());
    Body &cube = add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {cart.x, 0, 0});
    cube.mass = float(cart.mass);
    cube.linear_velocity = {float(cart.speed), 0, 0};
    connect(scene, cart.joint, 0, body, {cart.x, 0, 0}, Vector::UnitX());
  }
  articulate(scene, 0);
  return scene;
}

/* Speeds along x after a second, which is long after they have met. */
std::vector<double> speeds_after_meeting(const Scene &scene, uint32_t substeps)
{
  Settings settings;
  settings.substeps = substeps;
  World world(scene, settings, one_thread);
  run(world, 60);
  std::vector<double> speeds;
  for (const auto &body : world.precise_bodies()) {
    speeds.push_back(body.linear_velocity[0]);
    const bool is_link = speeds.size() <= scene.joints.size() + 1;
    if (is_link) CHECK(vector_of(body.angular_velocity).norm() < 1e-4);
  }
  return speeds;
}

/* Both after they have met, which keeps their momentum and leaves the share `restitution` of their relative speed. */
std::array<double, 2> met(double m, double v, double other_m, double other_v, double restitution)
{
  const double together = (m * v + other_m * other_v) / (m + other_m),
               apart = restitution * (other_v - v) / (m + other_m);
  return {together + other_m * apart, together - m * apart};
}

} // namespace

TEST_CASE("two links of one tree that meet part as bodies of their masses", "[articulations]")
{
  for (const uint32_t substeps : {1u, 4u})
    for (const float restitution : {0.0f, 1.0f}) {
      const auto speeds = speeds_after_meeting(carts_on_base({{-0.3, 1, 1}, {0.3, 2, -1}}, restitution), substeps);
      const auto expected = met(1, 1, 2, -1, restitution);
      CAPTURE(substeps, restitution);
      CHECK(std::abs(speeds[0]) < 1e-4);
      CHECK(speeds[1] == Approx(expected[0]).margin(2e-3));
      CHECK(speeds[2] == Approx(expected[1]).margin(2e-3));
    }
}

TEST_CASE("a link that meets what is fixed to its parent parts from both as from one body", "[articulations]")
{
  for (const uint32_t substeps : {1u, 4u})
    for (const float restitution : {0.0f, 1.0f}) {
      const Scene scene = carts_on_base({{-0.3, 1, 2}, {0.3, 1, 0, JointType::fixed}}, restitution);
      const auto speeds = speeds_after_meeting(scene, substeps);
      const auto expected = met(1, 2, base_mass + 1, 0, restitution);
      CAPTURE(substeps, restitution);
      CHECK(speeds[1] == Approx(expected[0]).margin(2e-3));
      CHECK(speeds[0] == Approx(expected[1]).margin(2e-3));
      CHECK(speeds[2] == Approx(speeds[0]).margin(1e-4));
    }
}

TEST_CASE("a link bounces off its parent alike, whichever of the two comes first", "[articulations]")
{
  for (const bool root_first : {true, false}) {
    Scene scene = without_friction(0.8f);
    const auto add = [&](double x, double mass, float speed) {
      Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {x, 0, 0});
      ball.mass = float(mass);
      ball.linear_velocity = {speed, 0, 0};
    };
    if (root_first) add(0, 0.05, 0);
    add(0.5, 1, -2);
    if (!root_first) add(0, 0.05, 0);
    const uint32_t root = root_first ? 0 : 1, link = 1 - root;
    connect(scene, JointType::slider, root, link, {0.5, 0, 0}, Vector::UnitX()).collide = true;
    articulate(scene, root);
    const auto speeds = speeds_after_meeting(scene, 4);
    const auto expected = met(0.05, 0, 1, -2, 0.8);
    CAPTURE(root_first);
    CHECK(speeds[root] == Approx(expected[0]).epsilon(1e-3));
    CHECK(speeds[link] == Approx(expected[1]).epsilon(1e-3));
  }
}

/* Contacts of such a tree walk (shared/articulations/contact.h). */
TEST_CASE("two links meet alike while their tree touches a body that moves", "[articulations]")
{
  Scene scene = carts_on_base({{-0.3, 1, 2}, {0.3, 1, -2}}, 0.8f);
  scene.bodies[0].mass = 1e5f; /* so that the touch of the other body does not turn it */
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, -0.3, 0});
  const auto speeds = speeds_after_meeting(scene, 4);
  CHECK(speeds[1] == Approx(-1.6).epsilon(0.01));
  CHECK(speeds[2] == Approx(1.6).epsilon(0.01));
}

/* Links are pushed apart no faster than bodies are, so no more energy can appear than all of them would have at that
 * speed. The lever by which the last link can leave the first is short. */
TEST_CASE("links that overlap deeply come apart no faster than bodies", "[articulations]")
{
  Scene scene = without_friction(0);
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, 0, 0}).mass = 4;
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.15f, 0.1f), {-0.02, -0.03, 0.26}).mass = 1;
  add_body(scene, BodyType::dynamic, capsule_shape(0.1f, 0.15f), {0.04, 0.02, 0.07}).mass = 1;
  connect(scene, JointType::hinge, 0, 1, {-0.01, -0.02, 0.13}, Vector::UnitX());
  connect(scene, JointType::hinge, 1, 2, {0.01, 0, 0.165}, Vector::UnitX());
  articulate(scene, 0);
  World world(scene, {}, one_thread);
  double most = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    most = std::max(most, double(world.statistics().kinetic_energy));
  }
  CHECK(most > 0.1);
  CHECK(most < 0.5 * 6 * Settings{}.push_speed * Settings{}.push_speed);
}

/* The contact pushes as a spring does that the overlap presses (Settings::contact_hertz), against the compliance of
 * pairs within a tree. That is bounded, and does not move the tree. */
TEST_CASE("cubes that overlap and are fixed to one base neither move it nor push without end", "[articulations]")
{
  const Scene scene = carts_on_base({{-0.05, 1, 0, JointType::fixed}, {0.05, 1, 0, JointType::fixed}}, 0);
  Settings settings;
  settings.events = true;
  World world(scene, settings, one_thread);
  std::vector<double> impulses;
  for (int k = 0; k < 480; ++k) {
    world.step();
    REQUIRE(world.contact_events().size() == 1);
    impulses.push_back(world.contact_events()[0].impulse);
  }
  CHECK(impulses[240] > 0);
  CHECK(impulses[479] == Approx(impulses[240]).epsilon(1e-3));
  for (const auto &body : world.precise_bodies()) CHECK(vector_of(body.linear_velocity).norm() < 1e-5);
}

TEST_CASE("chains of 64 freedoms and of 65 slide as far as theory says", "[articulations]")
{
  for (const int links : {59, 60}) { /* hinges between them, and six freedoms of the root */
    Scene scene = empty_scene();
    add_ground(scene);
    for (int k = 0; k < links; ++k) {
      add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.05f, 0.1f), {0.2 * k, 0.05, 0}).linear_velocity = {0, 0, 2};
      if (k > 0)
        connect(scene, JointType::hinge, uint32_t(k), uint32_t(k + 1), {0.2 * k - 0.1, 0.05, 0}, Vector::UnitZ());
    }
    articulate(scene, 1);
    World world(scene, {}, one_thread);
    run(world, 90);
    const double way = 2 * 2 / (2 * 0.6 * gravity);
    const auto bodies = world.precise_bodies();
    for (size_t k = 1; k < bodies.size(); ++k) {
      CAPTURE(links, k);
      CHECK(bodies[k].position[1] == Approx(0.05).margin(1e-3));
      CHECK(bodies[k].position[2] == Approx(way).margin(0.02));
    }
  }
}

/* Sums over the points of a contact have the same bits for mirrored points, so nothing leaves a plane of symmetry. */
TEST_CASE("a link that falls flat and bounces stays above where it began to the bit", "[articulations]")
{
  for (const bool has_hat : {false, true}) {
    Scene scene = empty_scene();
    scene.materials[0].restitution = 0.7f;
    add_ground(scene);
    add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.1f, 0.3f), {0, 0.6, 0});
    if (has_hat) {
      add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0, 0.9, 0});
      connect(scene, JointType::fixed, 1, 2, {0, 0.75, 0});
    }
    articulate(scene, 1);
    World world(scene, {}, one_thread);
    double highest = 0;
    for (int k = 0; k < 300; ++k) {
      world.step();
      for (const auto &body : world.precise_bodies()) {
        CAPTURE(has_hat, k);
        REQUIRE(body.position[0] == 0);
        REQUIRE(body.position[2] == 0);
        if (k > 30) highest = std::max(highest, body.position[1]);
      }
    }
    CHECK(highest > 0.2); /* it has bounced */
  }
}
