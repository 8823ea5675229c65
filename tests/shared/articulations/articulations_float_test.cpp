/* Trees in the precision of the kernels. */
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/shared/articulations/tree_model.h"

namespace tandem::float_trees {
#include "tests/shared/articulations/tree_in_memory.h"
} // namespace tandem::float_trees

using namespace tandem::tree_tests;
using namespace tandem::float_trees;
using tandem::Random;

TEST_CASE("articulations in float: links accelerate as dense matrices say, to some roundings", "[articulations]")
{
  Random random(11);
  for (int n = 0; n < 20; ++n) {
    const TreeModel model = random_tree(random, 20, n % 5);
    Tree tree(model);
    tree.set(random_state(random, model, 2));
    const Column found = tree.acceleration();
    const Column exact = DenseTree(model, tree.get())
                             .acceleration(Column::Zero(model.size()), Column::Zero(6 * int(model.links.size())));
    CAPTURE(n);
    CHECK((found - exact).norm() < 1e-5 * exact.norm());
  }
}

TEST_CASE("articulations in float: a chain of 100 links, whose arms are as long as links", "[articulations]")
{
  Random random(4);
  TreeModel model = random_tree(random, 100, TREE_JOINT_HINGE);
  for (size_t k = 1; k < model.links.size(); ++k) model.links[k].parent = int(k) - 1;
  Tree tree(model);
  tree.set(random_state(random, model, 0.5));
  const Column found = tree.acceleration();
  const Column exact =
      DenseTree(model, tree.get()).acceleration(Column::Zero(model.size()), Column::Zero(6 * int(model.links.size())));
  CHECK((found - exact).norm() < 1e-4 * exact.norm());
}

TEST_CASE("articulations in float: a free tree keeps its momentum to 1e-5 of that of its links", "[articulations]")
{
  Random random(1);
  for (int n = 0; n < 4; ++n) {
    TreeModel model = random_tree(random, 20, TREE_JOINT_FREE);
    model.gravity.setZero();
    Tree tree(model);
    tree.set(random_state(random, model, 2));
    const DenseTree start(model, tree.get());
    const Column momenta = start.masses() * start.velocities();
    double linear = 0, angular = 0;
    for (int k = 0; k < 20; ++k) {
      const Vector p = momenta.segment<3>(6 * k + 3), center = start.poses()[size_t(k)].center;
      linear += p.norm();
      angular += (Vector(momenta.segment<3>(6 * k)) + center.cross(p)).norm();
    }
    tree.run(1, 240);
    const auto now = DenseTree(model, tree.get()).momentum();
    CAPTURE(n, linear, angular);
    CHECK((now[0] - start.momentum()[0]).norm() < 1e-5 * linear);
    CHECK((now[1] - start.momentum()[1]).norm() < 1e-5 * angular);
  }
}

TEST_CASE("articulations in float: 1,000 km from the origin a tree moves with the bits that it has there",
          "[articulations]")
{
  Random random(2);
  const TreeModel model = random_tree(random, 12, TREE_JOINT_FREE);
  TreeState s = random_state(random, model, 2);
  s.root.setZero();
  Tree near(model), far(model);
  near.set(s);
  const Vector away(1e6, -1e6, 1e6);
  s.root = away;
  far.set(s);
  near.run(1, 240, 1);
  far.run(1, 240, 1);
  CHECK(near.get().v == far.get().v);
  CHECK(near.get().q == far.get().q);
  CHECK((far.get().root - away - near.get().root).norm() < 1e-5);
}

TEST_CASE("articulations in float: no speed leaves the range of numbers", "[articulations]")
{
  Random random(1);
  for (const double speed : {100.0, 1000.0, 10000.0})
    for (const int root : {TREE_JOINT_HINGE, TREE_JOINT_BALL, TREE_JOINT_FREE}) {
      TreeModel model = random_tree(random, 12, root);
      for (LinkModel &l : model.links)
        if (l.joint == TREE_JOINT_SLIDER) l.joint = TREE_JOINT_HINGE;
      Tree tree(model);
      tree.set(random_state(random, model, speed));
      tree.run(5, 1200, 1);
      CAPTURE(speed, root);
      CHECK(tree.get().v.allFinite());
      CHECK(tree.get().v.norm() < 1e3 * speed);
    }
}
