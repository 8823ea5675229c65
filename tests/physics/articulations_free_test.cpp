/* Articulations that nothing holds and nothing touches: their momentum and their energy stay, whichever body is the
 * root, however light it is, and however fast they turn. */
#include "tests/catch.h"
#include "tests/parity/articulations.h"
#include "tests/physics/articulate.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement alone{"serial", {}, false};

/* Trees of tree_crowd() without those that are held; the bodies of the latter are single ones. */
Scene free_trees(uint64_t seed)
{
  Scene scene = parity::tree_crowd(seed, 12, 0);
  scene.gravity = {0, 0, 0};
  for (const Articulation &tree : scene.articulations)
    if (tree.root == no_body)
      for (const uint32_t joint : tree.joints) scene.joints[joint].enabled = false;
  std::erase_if(scene.articulations, [](const Articulation &tree) { return tree.root == no_body; });
  for (Body &body : scene.bodies) body.filter_mask = 0;
  return scene;
}

/* Boxes on balls, each at one of those before it, that turn with up to `speed` rad/s about any axis. */
Scene turning_tree(uint64_t seed, uint32_t links, double speed)
{
  Random random(seed);
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t k = 0; k < links; ++k) {
    const uint32_t parent = k > 0 ? random.below(k) : 0;
    const Vector from = k > 0 ? vector_of(scene.bodies[parent].position) : Vector(0, 0, 0);
    const Vector way = k > 0 ? Vector(0.6 * direction(random)) : Vector(0, 0, 0);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.15f), point_of(from + way));
    body.filter_mask = 0;
    body.angular_velocity = vec3_of(random.uniform(0, speed) * direction(random));
    if (k > 0) connect(scene, JointType::ball, parent, k, from + 0.5 * way);
  }
  articulate(scene, 0);
  return scene;
}

/* A chain of boxes on balls along x, its root at the end. */
Scene straight_chain(uint32_t links, const Vec3 &gravity)
{
  Scene scene = empty_scene(gravity);
  for (uint32_t k = 0; k < links; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0.42 * k, 100, 0}).filter_mask = 0;
    if (k > 0) connect(scene, JointType::ball, k - 1, k, {0.42 * k - 0.21, 100, 0});
  }
  articulate(scene, 0);
  return scene;
}

double mass_of(const World &world)
{
  double mass = 0;
  for (const Body &body : world.scene().bodies) mass += double(body.mass);
  return mass;
}

Vector center_of(World &world)
{
  Vector sum = Vector::Zero();
  const auto bodies = world.precise_bodies();
  for (size_t k = 0; k < bodies.size(); ++k)
    sum += double(world.scene().bodies[k].mass) * vector_of(bodies[k].position);
  return sum / mass_of(world);
}

} // namespace

TEST_CASE("free articulations keep their momentum to 1e-5 of that of their links, whatever drives their joints",
          "[articulations]")
{
  for (uint64_t seed = 1; seed < 5; ++seed) {
    Scene scene = free_trees(seed);
    Random random(seed);
    for (Body &body : scene.bodies)
      if (body.type == BodyType::dynamic) body.linear_velocity = vec3_of(direction(random));
    World world(scene, {}, alone);
    world.step(); /* bodies move as their joints can from now on */
    const Momentum before = momentum_of(world);
    run(world, 120);
    const Momentum after = momentum_of(world);
    CHECK((after.linear - before.linear).norm() < 1e-5 * before.linear_scale);
    CHECK((after.angular - before.angular).norm() < 1e-5 * before.angular_scale);
  }
}

/* A contact that starts a step with its impulses must push both of its sides. */
TEST_CASE("a box and a free tree that forces press together keep their momentum", "[articulations]")
{
  for (const uint32_t substeps : {1u, 2u, 4u}) {
    Scene scene = straight_chain(3, {0, 0, 0});
    for (Body &body : scene.bodies) body.filter_mask = ~0u;
    add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0.42, 100.2, 0});
    Settings settings;
    settings.substeps = substeps;
    World world(scene, settings, alone);
    for (int k = 0; k < 60; ++k) {
      for (const uint32_t body : {1u, 3u}) /* along the line between the centres */
        world.add_force(BodyId{body, 1}, {{0, body == 1 ? 20.0f : -20.0f, 0}, {0, 0, 0}});
      world.step();
    }
    const Momentum after = momentum_of(world);
    CAPTURE(substeps);
    CHECK(world.statistics().contacts > 0);
    CHECK(world.precise_bodies()[3].position[1] - world.precise_bodies()[1].position[1] > 0.18);
    CHECK(after.linear.norm() < 1e-5 * 20); /* of the impulse that presses in a second */
  }
}

TEST_CASE("free trees that turn fast keep energy and momentum", "[articulations]")
{
  for (const double speed : {5.0, 20.0, 100.0})
    for (uint64_t seed = 1; seed <= 8; ++seed) {
      CAPTURE(speed, seed);
      const Settings settings = settings_with(1.0 / 60, speed > 20 ? 16 : 4);
      World world(turning_tree(seed, seed % 2 ? 4 : 8, speed), settings, alone);
      world.step();
      const Momentum before = momentum_of(world);
      const double energy = world.statistics().kinetic_energy;
      const Vector center = center_of(world), drift = before.linear / mass_of(world);
      for (int k = 0; k < 300; ++k) {
        world.step();
        CHECK(std::abs(world.statistics().kinetic_energy / energy - 1) < 0.02);
      }
      const Momentum after = momentum_of(world);
      CHECK((center_of(world) - center - 5 * drift).norm() < 1e-3);
      CHECK((after.linear - before.linear).norm() < 1e-4 * before.linear_scale);
      CHECK((after.angular - before.angular).norm() < (speed > 20 ? 0.1 : 0.01) * before.angular_scale);
    }
}

TEST_CASE("a free tree may have a root that is a millionth of its links", "[articulations]")
{
  for (const uint32_t links : {2u, 8u}) {
    Scene scene = straight_chain(links, {0, 0, 0});
    for (uint32_t k = 0; k < links; ++k) {
      scene.bodies[k].mass *= k % 2 ? 1e6f : 1.0f;
      scene.bodies[k].angular_velocity = {float(k % 3), 2, 1 - float(k)};
    }
    World world(scene, {}, alone);
    world.step();
    const double energy = world.statistics().kinetic_energy;
    run(world, 600);
    CHECK(std::abs(world.statistics().kinetic_energy / energy - 1) < 0.02);
    CHECK(fastest(world) < 30);
  }
}

TEST_CASE("a chain of a thousand links on balls falls straight", "[articulations]")
{
  World world(straight_chain(1000, {0, -10, 0}), {}, alone);
  run(world, 30);
  for (const auto &body : world.precise_bodies()) {
    CHECK(std::abs(body.position[1] - (100 - 0.5 * 10 * 0.25)) < 1e-4);
    CHECK(std::abs(body.linear_velocity[1] + 5) < 1e-3);
  }
}
