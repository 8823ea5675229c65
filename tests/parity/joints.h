/* joints.h - scenes with joints for the tests of equal bits. */
#pragma once

#include "tests/parity/parity.h"
#include "tests/physics/joints.h"

namespace tandem::parity {

/* Takes a scene on from a snapshot, on another backend, and from a state gone back to; ask: what else a
 * test wants of the world that the snapshot makes, beside the original. */
template <class Ask> void require_goes_on(const Scene &scene, const Settings &settings, const Ask &ask)
{
  using physics_tests::run;
  World original(scene, settings, {"serial", {}, false});
  run(original, 15);
  const std::vector<std::byte> snapshot = original.save();
  World world(snapshot, {"tbb:threads=3,lanes=8", {}, false});
  CHECK(world.save() == snapshot);
  ask(world, original);
  for (int k = 0; k < 15; ++k) {
    world.step();
    original.step();
    REQUIRE(world.state_hash() == original.state_hash());
  }
  original.keep_states(8);
  const uint64_t before = original.state_hash();
  run(original, 3);
  const uint64_t after = original.state_hash();
  original.go_back(3);
  CHECK(original.state_hash() == before);
  run(original, 3);
  CHECK(original.state_hash() == after);
}

/* A bridge of planks, which overlap a little, on hinges between two posts, and boxes that fall onto it. */
inline Scene bridge(int planks = 8, int boxes = 6)
{
  using namespace physics_tests;
  Scene scene = empty_scene();
  scene.name = "bridge";
  add_ground(scene);
  for (const double x : {-0.5, planks + 0.5}) add_body(scene, BodyType::fixed, box_shape(0.4f, 1, 1), {x, 2, 0});
  for (int i = 0; i < planks; ++i) {
    add_body(scene, BodyType::dynamic, box_shape(0.52f, 0.1f, 1), {i + 0.5, 3, 0}).mass = 5;
    const auto plank = uint32_t(scene.bodies.size() - 1);
    connect(scene, JointType::hinge, i == 0 ? 1 : plank - 1, plank, {double(i), 3, 0}, Vector::UnitZ());
  }
  connect(scene, JointType::hinge, uint32_t(scene.bodies.size() - 1), 2, {double(planks), 3, 0}, Vector::UnitZ());
  for (int i = 0; i < boxes; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.25f), {1 + 0.9 * i, 3.4 + 0.1 * i, 0.2 * (i % 3)});
  return scene;
}

/* Each kind of limit and drive on the types that have it, once to the world and once between bodies. */
inline std::string joint_axes() { return TANDEM_SOURCE_DIR "/tests/scenes/joint_axes.json"; }

/* Bodies in a heap with random joints of the types that only hold, between neighbours, the world, what is fixed and
 * what is kinematic; some collide though they are joined, some have locks, and one has more joints than there are
 * colours. */
inline Scene joint_crowd(uint64_t seed = 1, uint32_t bodies = 110)
{
  using namespace physics_tests;
  Random random(seed);
  Scene scene = empty_scene();
  scene.name = "joint crowd";
  add_ground(scene);
  add_body(scene, BodyType::kinematic, box_shape(0.5f, 0.5f, 0.5f), {0, 4, -2}).angular_velocity = {0, 1, 0};
  for (uint32_t i = 0; i < bodies; ++i) {
    const Shape shape = i % 3 ? box_shape(0.3f, 0.2f, 0.4f) : sphere_shape(0.3f);
    const Point at{0.7 * (i % 5), 0.6 + 0.7 * (i / 25), 0.7 * (i / 5 % 5)};
    Body &body = add_body(scene, BodyType::dynamic, shape, at);
    body.orientation = any_turn(random);
    body.linear_velocity = vec3_of(direction(random));
    body.mass = float(random.uniform(0.5, 2));
    if (random.below(12) == 0) body.linear_locks = {false, false, true};
    if (random.below(12) == 0) body.angular_locks = {true, false, false};
  }
  const auto any_type = [&] { return all_joint_types[random.below(uint32_t(std::size(all_joint_types)))]; };
  const auto middle = [&](uint32_t a, uint32_t b) {
    return Vector(0.5 * (vector_of(scene.bodies[a].position) + vector_of(scene.bodies[b].position)));
  };
  for (uint32_t i = 3; i < bodies + 2; ++i) {
    if (random.below(3) == 0) continue;
    const uint32_t other = random.below(8) == 0 ? no_body : random.below(8) == 0 ? 1 : i - 1;
    const bool turned = random.below(2) == 0;
    const Vector at = other == no_body ? vector_of(scene.bodies[i].position) : middle(i, other);
    connect(scene, any_type(), turned ? i : other, turned ? other : i, at, direction(random)).collide =
        random.below(4) == 0;
  }
  for (uint32_t i = 3; i < std::min(bodies + 2, 75u); ++i) connect(scene, JointType::ball, 2, i, middle(2, i));
  return scene;
}

} // namespace tandem::parity
