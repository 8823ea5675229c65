/* Worlds that choose their substeps: what joints bear gets as many as it needs, others the bits of four. */
#include <cmath>

#include "host/catalog/catalog.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings chosen_by_joints() { return settings_with(1.0 / 60, automatic_substeps); }

/* A bar of 1 kg and a metre hangs from the world on a ball joint, and a ball of this mass from the bar. */
Scene laden_bar(double load)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.5f, 0.1f), {0, -0.5, 0}).mass = 1;
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {0, -1.3, 0}).mass = float(load);
  scene.bodies.back().filter_mask = 0;
  connect(scene, JointType::ball, no_body, 0, {0, 0, 0});
  connect(scene, JointType::ball, 0, 1, {0, -1, 0});
  return scene;
}

/* The joint above the bar bears both, (1 + load) g, and moves the bar alone: it may be open by half of 5 mm, as stiff
 * as a quarter of the substep rate. */
uint32_t substeps_of(double load)
{
  const double give = (1 + load) * gravity, omega = 2 * M_PI * 0.25;
  const double rate = std::sqrt(give / (omega * omega * 0.0025));
  uint32_t substeps = 4;
  while (substeps * 60 < rate) substeps *= 2;
  return substeps;
}

/* A ball of 1 kg and 0.3 m, fixed to the world, with six arms of 100 kg and a metre. */
Scene overloaded_hub()
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {0, 0, 0}).mass = 1;
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  for (uint32_t i = 1; i <= 6; ++i) {
    const Vector at(std::cos(i / 4.0), 0, std::sin(i / 4.0));
    add_body(scene, BodyType::dynamic, sphere_shape(0.3f), point_of(at)).mass = 100;
    connect(scene, JointType::ball, 0, i, at);
  }
  for (Body &body : scene.bodies) body.filter_mask = 0;
  return scene;
}

double opened_by_hub(const Settings &settings)
{
  World world(overloaded_hub(), settings, {});
  run(world, 300);
  return open_joints(world).max_distance;
}

} // namespace

TEST_CASE("automatic substeps: a load on a joint gets what its opening needs", "[physics]")
{
  const double load = GENERATE(1.0, 20.0, 80.0, 250.0, 1000.0);
  World world(laden_bar(load), chosen_by_joints(), {});
  run(world, 300);
  CAPTURE(load);
  CHECK(world.statistics().substeps == substeps_of(load));
  CHECK(open_joints(world).max_distance < 0.0025);
}

TEST_CASE("automatic substeps: a hub that four substeps tear off carries its arms", "[physics]")
{
  CHECK_FALSE(opened_by_hub(settings_with(1.0 / 60)) < 1);
  CHECK(opened_by_hub(chosen_by_joints()) < 0.005);
}

TEST_CASE("automatic substeps: joints that bear little have the bits of four", "[physics]")
{
  const char *name = GENERATE("pendulums", "newton-cradle", "humanoid:n=2", "joint-grid:columns=4,rows=3");
  World chosen(load_scene(name), chosen_by_joints(), {}), four(load_scene(name), settings_with(1.0 / 60), {});
  run(chosen, 60);
  run(four, 60);
  CAPTURE(name);
  CHECK(chosen.statistics().substeps == 4);
  CHECK(chosen.body_hash() == four.body_hash());
}

TEST_CASE("automatic substeps: they become fewer when a joint has lost its load", "[physics]")
{
  World world(laden_bar(250), chosen_by_joints(), {});
  run(world, 200);
  REQUIRE(world.statistics().substeps == 16);
  world.destroy_body(world.body_ids().back());
  run(world, 125);
  CHECK(world.statistics().substeps == 4);
}

TEST_CASE("automatic substeps: a wheel that spins fast off its centre gets what its circle needs", "[physics]")
{
  /* The end of an arm of 0.5 m at 20 rad/s leaves its circle by 0.5 * 400 h^2 / 2, of which a pass leaves 1 / 0.28. */
  Scene scene = empty_scene({0, 0, 0});
  Body &wheel = add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {0.5, 0, 0});
  wheel.angular_velocity = {0, 0, 20};
  wheel.linear_velocity = {0, 10, 0};
  connect(scene, JointType::hinge, no_body, 0, {0, 0, 0}, Vector::UnitZ());
  World world(scene, chosen_by_joints(), {});
  run(world, 300);
  CHECK(world.statistics().substeps == 8); /* sqrt(1.77 * 200 / 0.0025) = 376 a second */
  CHECK(open_joints(world).max_distance < 0.0025);
}
