/* couplings.h - scenes with couplings for the tests of equal bits. */
#pragma once

#include "tests/parity/joints.h"

namespace tandem::parity {

/* Frames that fall on the ground, some of them held by the world, with wheels, racks, screws and ropes, coupled at
 * random; one wheel has more couplings than there are colours. */
inline Scene coupling_crowd(uint64_t seed = 1, uint32_t wheels = 90)
{
  using namespace physics_tests;
  Random random(seed);
  Scene scene = empty_scene();
  scene.name = "coupling crowd";
  add_ground(scene);
  std::vector<uint32_t> turning, sliding, hanging; /* joints */
  const auto join = [&](JointType type, uint32_t a, uint32_t b, const Vector &at, const Vector &axis) {
    connect(scene, type, a, b, at, axis);
    return uint32_t(scene.joints.size() - 1);
  };
  uint32_t frame = no_body;
  for (uint32_t i = 0; i < wheels; ++i) {
    const Vector at(0.9 * (i % 6), 0.7 + 0.8 * (i / 36), 0.9 * (i / 6 % 6));
    if (i % 7 == 0) {
      frame = no_body;
      if (random.below(3) > 0) {
        add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), point_of(at + Vector(0, 0.3, 0.45))).mass = 3;
        frame = uint32_t(scene.bodies.size() - 1);
      }
    }
    Body &body =
        add_body(scene, BodyType::dynamic, i % 2 ? box_shape(0.2f, 0.1f, 0.25f) : sphere_shape(0.2f), point_of(at));
    body.orientation = any_turn(random);
    body.mass = float(random.uniform(0.5, 2));
    if (random.below(14) == 0) body.linear_locks = {false, false, true};
    const auto number = uint32_t(scene.bodies.size() - 1);
    const uint32_t kind = i == 0 ? 0 : random.below(5);
    const bool turned = random.below(2) == 0; /* which side the frame is */
    const uint32_t a = turned ? number : frame, b = turned ? frame : number;
    if (kind < 3) turning.push_back(join(JointType::hinge, a, b, at, direction(random)));
    else if (kind == 3) sliding.push_back(join(JointType::cylindrical, a, b, at, direction(random)));
    else hanging.push_back(join(JointType::distance, a, b, at + Vector(0, 1, 0), Vector::UnitX()));
  }
  scene.joints[turning[0]].rotations[0] = {.target_velocity = 3, .motor = true, .max_force = 5};
  const auto any_of_joints = [&](const std::vector<uint32_t> &joints) {
    return joints[random.below(uint32_t(joints.size()))];
  };
  const auto any_teeth = [&] { return int32_t(8 + random.below(20)) * (random.below(2) ? 1 : -1); };
  for (uint32_t k = 0; k < wheels; ++k) {
    Coupling coupling;
    coupling.type = static_cast<CouplingType>(random.below(4));
    coupling.joint_a = k < 80 && k % 14 != 0 ? turning[0] : any_of_joints(turning);
    if (coupling.joint_a == turning[0] && coupling.type == CouplingType::pulley) coupling.type = CouplingType::gear;
    switch (coupling.type) {
    case CouplingType::gear:
      coupling.joint_b = any_of_joints(turning);
      coupling.teeth_a = any_teeth();
      coupling.teeth_b = any_teeth();
      break;
    case CouplingType::rack_and_pinion:
      coupling.joint_b = any_of_joints(sliding);
      if (k % 5 == 0) coupling.joint_a = coupling.joint_b; /* a screw */
      coupling.teeth_a = any_teeth();
      coupling.travel = float(random.uniform(0.2, 1));
      break;
    case CouplingType::pulley:
      coupling.joint_a = any_of_joints(hanging);
      coupling.joint_b = any_of_joints(hanging);
      coupling.ratio = float(random.uniform(0.5, 2));
      coupling.offset = float(random.uniform(0.5, 2));
      coupling.only_pulls = random.below(3) > 0;
      break;
    case CouplingType::mimic:
      coupling.joint_b = any_of_joints(random.below(2) ? turning : sliding);
      coupling.ratio = float(random.uniform(-2, 2));
      break;
    }
    if (coupling.joint_a != coupling.joint_b || coupling.type == CouplingType::rack_and_pinion)
      scene.couplings.push_back(coupling);
  }
  return scene;
}

/* Pairs of damped pendulums, the two of each coupled. Bodies 2 i and 2 i + 1 are a pair. */
inline Scene coupled_pendulums(uint32_t pairs = 8)
{
  using namespace physics_tests;
  Scene scene = empty_scene();
  scene.name = "coupled pendulums";
  for (uint32_t i = 0; i < 2 * pairs; ++i) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.3f, 0.2f), {1.0 * i, 0, 0.1 * (i / 2)});
    body.angular_damping = 6;
    connect(scene, JointType::hinge, no_body, i, {1.0 * i, 0.5, 0});
  }
  for (uint32_t i = 0; i < pairs; ++i) {
    Coupling coupling;
    coupling.type = i % 2 ? CouplingType::gear : CouplingType::mimic;
    coupling.joint_a = 2 * i;
    coupling.joint_b = 2 * i + 1;
    if (i % 2) coupling.teeth_a = 10, coupling.teeth_b = i % 4 == 1 ? 20 : -20;
    scene.couplings.push_back(coupling);
  }
  std::reverse(scene.couplings.begin(), scene.couplings.end());
  return scene;
}

} // namespace tandem::parity
