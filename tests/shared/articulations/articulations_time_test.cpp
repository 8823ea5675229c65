/* How much time of a processor a substep of a tree takes, at width 1, in both layouts of shared/articulations/tree.h.
 * Nothing is judged; docs/articulations.md has the figures of one machine. Run by hand: tandem_tests "[.time]". */
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <iostream>
#include <memory>
#include <vector>

#include "tests/catch.h"
#include "tests/shared/articulations/tree_model.h"

namespace tandem::float_trees {
#include "tests/shared/articulations/tree_in_memory.h"
} // namespace tandem::float_trees

using namespace tandem::tree_tests;
using namespace tandem::float_trees;
using tandem::Random;

namespace {

/* A free trunk, two legs and two arms: 21 hinges with springs, dampers and, if asked for, limits. */
TreeModel humanoid(bool limited)
{
  constexpr int parents[] = {-1, 0, 1, 2, 0, 4, 5, 6, 7, 8, 0, 10, 11, 12, 13, 14, 2, 16, 17, 2, 19, 20};
  Random random(3);
  TreeModel model;
  for (const int parent : parents) {
    LinkModel l;
    l.parent = parent;
    l.joint = parent < 0 ? TREE_JOINT_FREE : TREE_JOINT_HINGE;
    l.mass = 2;
    l.moments = Vector(0.02, 0.03, 0.025);
    l.stiffness = 20;
    l.damping = 1;
    l.armature = 0.01;
    if (limited) l.lower = -1, l.upper = 1;
    if (parent >= 0) {
      l.from_parent = random_vector(random, 0.2);
      l.from_center = random_vector(random, 0.2);
      l.axes_in_parent = random_turn(random);
      l.axes_in_link = random_turn(random);
    }
    model.links.push_back(l);
  }
  return model;
}

Parameters parameters_of(double h)
{
  Parameters p{};
  p.step = p.substep = memory_real(h);
  p.inverse_substep = memory_real(1 / h);
  p.joint_bias_rate = memory_real(0.2 / h);
  p.joint_mass_scale = memory_real(0.9);
  p.joint_impulse_scale = memory_real(0.1);
  return p;
}

/* Microseconds a tree and substep, the shortest of five rounds. */
double time_of(const std::vector<articulation> &trees, uint has_rows)
{
  constexpr double h = 1.0 / 240;
  const Parameters p = parameters_of(h);
  for (const articulation &t : trees) prepare_tree(&t, real(h));
  double shortest = 1e30;
  constexpr int substeps = 20;
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    for (int k = 0; k < substeps; ++k)
      for (const articulation &t : trees) advance_tree(&p, &t, make_vec3(0, -10, 0), has_rows);
    const double took = 1e6 * double(std::clock() - start) / CLOCKS_PER_SEC;
    shortest = std::min(shortest, took / substeps / double(trees.size()));
  }
  return shortest;
}

} // namespace

TEST_CASE("articulations: microseconds of a substep of a humanoid", "[.time]")
{
  for (const bool limited : {false, true})
    for (const uint count : {1u, 64u, 1024u}) {
      const TreeModel model = humanoid(limited);
      const TreeState state = rest_of(model);
      std::vector<std::unique_ptr<Tree>> pieces;
      Tree beside(model, count);
      std::vector<articulation> in_pieces, together;
      for (uint i = 0; i < count; ++i) {
        pieces.push_back(std::make_unique<Tree>(model));
        pieces.back()->set(state);
        in_pieces.push_back(pieces.back()->t);
        beside.t = beside.articulation_of(count, i);
        beside.set(state);
        together.push_back(beside.t);
      }
      std::cout << count << " trees" << (limited ? " with limits" : "") << ": each in one piece "
                << time_of(in_pieces, limited) << ", beside each other " << time_of(together, limited) << " us\n";
    }
}
