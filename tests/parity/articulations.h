/* articulations.h - scenes with articulations for the tests of equal bits. */
#pragma once

#include "tests/parity/joints.h"

namespace tandem::parity {

/* Trees of boxes with random joints that fall on the ground, on one another and on boxes; some are held by the world,
 * and one is a chain with more contacts than there are colours. shape: of all that moves. */
inline Scene tree_crowd(uint64_t seed = 1, uint32_t trees = 12, uint32_t chain = 70,
                        const Shape &shape = box_shape(0.2f, 0.1f, 0.15f))
{
  using namespace physics_tests;
  constexpr JointType types[] = {JointType::hinge, JointType::hinge, JointType::slider, JointType::ball,
                                 JointType::fixed};
  Random random(seed);
  Scene scene = empty_scene();
  scene.name = "crowd of trees";
  add_ground(scene);
  const auto add_link = [&](const Vector &at) {
    Body &body = add_body(scene, BodyType::dynamic, shape, point_of(at));
    body.orientation = any_turn(random);
    body.mass = float(random.uniform(0.5, 2));
    body.gravity_factor = random.below(8) == 0 ? 0.5f : 1.0f;
    return uint32_t(scene.bodies.size() - 1);
  };
  const auto join = [&](Articulation &tree, JointType type, uint32_t a, uint32_t b, const Vector &at) {
    Joint &joint = connect(scene, type, a, b, at, direction(random));
    JointAxis &axis = type == JointType::slider ? joint.directions[0] : joint.rotations[0];
    if (random.below(2) == 0 && type != JointType::fixed) axis.damping = 0.5f;
    if (random.below(3) == 0 && type != JointType::fixed) axis.stiffness = 20;
    if (type == JointType::ball) joint.rotations = {axis, axis, axis};
    if (random.below(3) == 0 && (type == JointType::hinge || type == JointType::slider))
      axis.lower = -0.2f, axis.upper = 0.3f, axis.friction = 0.5f;
    if (random.below(6) == 0 && type == JointType::hinge) axis = {.target_velocity = 2, .motor = true, .max_force = 5};
    tree.joints.push_back(uint32_t(scene.joints.size() - 1));
  };
  for (uint32_t i = 0; i < trees; ++i) {
    Articulation tree;
    const Vector at(1.1 * (i % 4), 0.5 + 0.8 * (i / 8), 1.1 * (i / 4 % 2));
    const uint32_t root = add_link(at), links = 1 + random.below(8);
    std::vector<uint32_t> of_tree{root};
    if (i % 4 == 3) join(tree, types[random.below(4)], no_body, root, at + Vector(0, 0.3, 0));
    else tree.root = root;
    for (uint32_t k = 1; k < links; ++k) {
      const uint32_t parent = of_tree[random.below(uint32_t(of_tree.size()))];
      const Vector from = vector_of(scene.bodies[parent].position), way = 0.35 * direction(random);
      of_tree.push_back(add_link(from + way));
      const bool turned = random.below(2) == 0;
      join(tree, types[random.below(5)], turned ? of_tree.back() : parent, turned ? parent : of_tree.back(),
           from + 0.5 * way);
    }
    scene.articulations.push_back(tree);
  }
  Articulation long_chain;
  for (uint32_t k = 0; k < chain; ++k) {
    const Vector at(0.42 * k - 2, 0.15, -1.5);
    const uint32_t link = add_link(at);
    scene.bodies[link].orientation = {0, 0, 0, 1};
    if (k == 0) long_chain.root = link;
    else join(long_chain, JointType::ball, link - 1, link, at - Vector(0.21, 0, 0));
  }
  if (chain > 0) scene.articulations.push_back(long_chain);
  for (uint32_t i = 0; i < trees; ++i)
    add_body(scene, BodyType::dynamic, shape, {1.1 * (i % 4) + 0.3, 2.2, 1.1 * (i / 4 % 2) - 0.2}).mass = 0.7f;
  return scene;
}

/* Hinges and sliders of each tree, of which every second one is coupled with the next. */
inline void couple_trees(Scene &scene, Random &random)
{
  for (const Articulation &tree : scene.articulations) {
    std::vector<uint32_t> able;
    for (const uint32_t joint : tree.joints)
      if (scene.joints[joint].type == JointType::hinge || scene.joints[joint].type == JointType::slider)
        able.push_back(joint);
    for (size_t k = 0; k + 1 < able.size(); k += random.below(2) + 1) {
      Coupling &mimic = scene.couplings.emplace_back();
      mimic.type = CouplingType::mimic;
      mimic.joint_a = able[k];
      mimic.joint_b = able[k + 1];
      mimic.ratio = float(random.uniform(-2, 2));
    }
  }
}

/* tree_crowd() of which joints are coupled: with the next one of their tree, which shares bodies with them or not. */
inline Scene coupled_trees(uint64_t seed = 1, uint32_t trees = 12, uint32_t chain = 0,
                           const Shape &shape = box_shape(0.2f, 0.1f, 0.15f))
{
  Scene scene = tree_crowd(seed, trees, chain, shape);
  Random random(seed + 300);
  couple_trees(scene, random);
  return scene;
}

/* tree_crowd() whose trees have loops, and hang on each other, on single bodies and on the world, by joints of many
 * types with limits, springs and motors. */
inline Scene joined_trees(uint64_t seed = 1, uint32_t trees = 10)
{
  using namespace physics_tests;
  static constexpr JointType types[] = {JointType::ball,     JointType::hinge,      JointType::slider,
                                        JointType::fixed,    JointType::distance,   JointType::universal,
                                        JointType::parallel, JointType::cylindrical};
  Scene scene = tree_crowd(seed, trees, 0);
  Random random(seed + 100);
  std::vector<std::vector<uint32_t>> links;
  for (const Articulation &tree : scene.articulations) {
    std::vector<uint32_t> &own = links.emplace_back();
    if (tree.root != no_body) own.push_back(tree.root);
    for (const uint32_t joint : tree.joints) own.push_back(scene.joints[joint].body_b);
  }
  const auto join = [&](uint32_t a, uint32_t b) {
    const Vector from = a == no_body ? vector_of(scene.bodies[b].position) : vector_of(scene.bodies[a].position);
    const Vector at = 0.5 * (from + vector_of(scene.bodies[b].position));
    Joint &joint = connect(scene, types[random.below(8)], a, b, at, direction(random));
    if (joint.type == JointType::distance) joint.directions[0].upper = 0.05f;
    if (joint.type == JointType::cylindrical) joint.rotations[0].damping = 0.5f;
    if (joint.type == JointType::hinge) joint.rotations[0] = {.lower = -0.4f, .upper = 0.5f, .stiffness = 5};
    if (joint.type == JointType::slider) joint.directions[0] = {.target_velocity = 1, .motor = true, .max_force = 4};
    if (random.below(8) == 0) joint.break_force = 200;
  };
  for (size_t k = 0; k < links.size(); ++k) {
    const auto any_of = [&](const std::vector<uint32_t> &own) { return own[random.below(uint32_t(own.size()))]; };
    const uint32_t one = any_of(links[k]), other = any_of(links[k]), last = uint32_t(scene.bodies.size() - 1);
    if (one != other) join(one, other);
    if (k % 2 == 0) join(any_of(links[(k + 1) % links.size()]), one);
    if (k % 3 == 0) join(last - uint32_t(k), other);
    if (k % 5 == 0) join(no_body, one);
  }
  return scene;
}

} // namespace tandem::parity
