/* Trees in double precision against dense matrices (tree_model.h) and maximal coordinates (maximal.h): what remains is
 * the rounding of doubles, or that of the difference quotients of the oracles. */
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/shared/articulations/maximal.h"

/* Types of memory are wider too, so all of it lives in a namespace of its own, as in minicl/reference.cpp. */
#define TANDEM_REFERENCE
namespace tandem::reference_trees {
#include "tests/shared/articulations/tree_in_memory.h"
} // namespace tandem::reference_trees

using namespace tandem::tree_tests;
using namespace tandem::reference_trees;
using tandem::Random;

namespace {

constexpr size_t most = 20;

struct Case {
  TreeModel model;
  TreeState state;
};

/* Trees of 1 to 20 links with each kind of root; gear: armature, springs and dampers. */
template <class Check> void for_random_trees(bool gear, const Check &check)
{
  Random random(7);
  for (int n = 0; n < 40; ++n) {
    Case c;
    c.model = random_tree(random, 1 + random.below(most), n % 5);
    for (LinkModel &l : c.model.links) {
      if (!gear || l.joint == TREE_JOINT_FREE) continue;
      l.armature = random.uniform(0, 0.3);
      l.stiffness = random.uniform(0, 100);
      l.damping = random.uniform(0, 10);
      l.target = random.uniform(-1, 1);
      l.target_speed = random.uniform(-1, 1);
    }
    c.state = random_state(random, c.model, 3);
    CAPTURE(n, c.model.links.size());
    check(random, c);
  }
}

Column random_column(Random &random, int size)
{
  Column c(size);
  for (int i = 0; i < size; ++i) c[i] = random.uniform(-5, 5);
  return c;
}

Column six(const spatial_motion &m)
{
  Column c(6);
  c << Tree::eigen(m.angular), Tree::eigen(m.linear);
  return c;
}
spatial_force force_of(const Column &six) { return {Tree::vector(six.head<3>()), Tree::vector(six.tail<3>())}; }

std::vector<uint> first_velocities(const TreeModel &model)
{
  std::vector<uint> first;
  for (size_t k = 0; k < model.links.size(); ++k) first.push_back(uint(model.first(k)));
  return first;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Dense jacobian_of(const Tree &tree, const TreeModel &model, uint link, const Vector &arm)
{
  RowMajor j = RowMajor::Zero(6, model.size());
  find_jacobian(&tree.t, first_velocities(model).data(), uint(model.size()), link, Tree::vector(arm), j.data());
  return j;
}

Column pose_of(const DenseTree &d, size_t link) { return d.poses()[link].center; }

} // namespace

TEST_CASE("articulations: the links are where the joints put them, and move as these do", "[articulations]")
{
  for_random_trees(false, [](Random &, const Case &c) {
    Tree tree(c.model);
    tree.set(c.state);
    tree.prepare(0);
    const DenseTree dense(c.model, c.state);
    const Column velocities = dense.velocities();
    for (uint k = 0; k < tree.t.links; ++k) {
      const vec4 q = load_work(&tree.t, k, WORK_ORIENTATION);
      CHECK(Turn(q.w, q.x, q.y, q.z).angularDistance(dense.poses()[k].turn) < 1e-13);
      const double_float3 p = link_position(&tree.t, k);
      CHECK((Tree::eigen(p.high) + Tree::eigen(p.low) - dense.poses()[k].center).norm() < 1e-13);
      CHECK((six(load_motion(&tree.t, k, WORK_VELOCITY)) - velocities.segment<6>(6 * k)).norm() < 1e-12);
    }
  });
}

TEST_CASE("articulations: the Jacobian of a point is what the point moves by, and so is the oracle's",
          "[articulations]")
{
  for_random_trees(false, [](Random &random, const Case &c) {
    Tree tree(c.model);
    tree.set(c.state);
    tree.prepare(0);
    const DenseTree dense(c.model, c.state);
    const uint link = random.below(tree.t.links);
    const Vector arm = random_vector(random, 1);
    const Dense j = jacobian_of(tree, c.model, link, arm);
    CHECK((j - dense.jacobian_of(link, dense.poses()[link].center + arm)).norm() < 1e-12);
    for (int i = 0; i < c.model.size(); ++i) {
      TreeState s = c.state;
      s.v = Column::Unit(c.model.size(), i);
      constexpr double e = 1e-6;
      const DenseTree ahead(c.model, moved(c.model, s, e)), behind(c.model, moved(c.model, s, -e));
      const Column moves = (pose_of(ahead, link) - pose_of(behind, link)) / (2 * e);
      CHECK((jacobian_of(tree, c.model, link, Vector::Zero()).col(i).tail<3>() - moves).norm() < 1e-8);
    }
  });
}

TEST_CASE("articulations: the mass matrix is J^T M J with armatures, and positive definite", "[articulations]")
{
  for_random_trees(true, [](Random &, const Case &c) {
    Tree tree(c.model);
    tree.set(c.state);
    const DenseTree dense(c.model, c.state);
    for (const double h : {0.0, 0.01}) {
      tree.prepare(h);
      RowMajor m = RowMajor::Zero(c.model.size(), c.model.size());
      find_mass_matrix(&tree.t, first_velocities(c.model).data(), uint(c.model.size()), m.data());
      const Dense expected = dense.mass_matrix(h);
      CHECK((m - expected).norm() <= 1e-13 * expected.norm());
      CHECK((m - m.transpose()).norm() == 0);
      if (m.size() > 0) CHECK(m.llt().info() == Eigen::Success);
    }
  });
}

TEST_CASE("articulations: links accelerate as in maximal coordinates", "[articulations]")
{
  for_random_trees(false, [](Random &random, const Case &c) {
    Tree tree(c.model);
    tree.set(c.state);
    const Column joints = random_column(random, c.model.size()), outer = random_column(random, 6 * int(tree.t.links));
    tree.set_joint_forces(joints);
    tree.set_outer_forces(outer);
    const Column acceleration = tree.acceleration();
    const DenseTree dense(c.model, c.state);
    const Column maximal = MaximalTree(c.model, c.state).accelerations(joints, outer);
    CHECK((dense.jacobian() * acceleration + dense.bias() - maximal).norm() <= 1e-8 * (1 + maximal.norm()));
    CHECK((acceleration - dense.acceleration(joints, outer)).norm() <= 1e-8 * (1 + acceleration.norm()));
  });
}

TEST_CASE("articulations: inverse dynamics undo the accelerations of forces", "[articulations]")
{
  for_random_trees(true, [](Random &random, Case c) {
    for (LinkModel &l : c.model.links) l.stiffness = l.damping = 0;
    Tree tree(c.model);
    tree.set(c.state);
    const Column joints = random_column(random, c.model.size());
    tree.set_joint_forces(joints);
    tree.set_outer_forces(random_column(random, 6 * int(tree.t.links)));
    tree.set_pending(tree.acceleration());
    find_joint_forces(&tree.t, Tree::vector(c.model.gravity));
    CHECK((tree.pending() - joints).norm() <= 1e-10 * (1 + joints.norm()));
  });
}

namespace {

/* A tree that is prepared for a substep, and its mass matrix in double precision. */
struct PreparedTree {
  explicit PreparedTree(const Case &c)
      : tree(c.model), dense(c.model, c.state),
        inverse(dense.mass_matrix(h).ldlt().solve(Dense::Identity(c.model.size(), c.model.size())))
  {
    tree.set(c.state);
    tree.prepare(h);
  }

  static constexpr double h = 0.01;
  Tree tree;
  DenseTree dense;
  Dense inverse;
};

} // namespace

TEST_CASE("articulations: impulses on links move the whole tree as its inverse mass matrix says", "[articulations]")
{
  for_random_trees(true, [](Random &random, const Case &c) {
    auto [tree, dense, inverse] = PreparedTree(c);
    Column expected = Column::Zero(c.model.size());
    for (int n = 0; n < 3; ++n) {
      const uint link = random.below(tree.t.links), other = random.below(tree.t.links);
      const Column impulse = random_column(random, 6);
      push_link(&tree.t, link, force_of(impulse));
      expected += inverse * dense.jacobian().middleRows<6>(6 * int(link)).transpose() * impulse;
      const Column seen = six(pending_change(&tree.t, other));
      CHECK((seen - dense.jacobian().middleRows<6>(6 * int(other)) * expected).norm() < 1e-10);
    }
    settle_tree(&tree.t);
    CHECK((tree.get().v - c.state.v - expected).norm() < 1e-10);
    const Column velocities = dense.jacobian() * (c.state.v + expected);
    for (uint k = 0; k < tree.t.links; ++k)
      CHECK((six(load_motion(&tree.t, k, WORK_VELOCITY)) - velocities.segment<6>(6 * k)).norm() < 1e-10);
  });
}

TEST_CASE("articulations: a sweep sees at each link and joint all that it has pushed before", "[articulations]")
{
  for_random_trees(true, [](Random &random, const Case &c) {
    auto [tree, dense, inverse] = PreparedTree(c);
    const uint pushed = random.below(tree.t.links); /* before the sweep */
    const Column first = random_column(random, 6);
    push_link(&tree.t, pushed, force_of(first));
    Column expected = inverse * dense.jacobian().middleRows<6>(6 * int(pushed)).transpose() * first;
    for (uint k = 0; k < tree.t.links; ++k) {
      const tree_link l = tree_link_of(&tree.t, k);
      visited_link v;
      go_to_link_if(true, &tree.t, l, k);
      load_visited_link(&tree.t, l, &v);
      const link_before before{k > 0 ? load_motion(&tree.t, k - 1, WORK_CHANGE) : no_motion()};
      arrive_at_link(&tree.t, l, k, &before, &v);
      const double change = v.change.joint.x;
      const auto jacobian = dense.jacobian().middleRows<6>(6 * int(k));
      if (has_one_freedom(l)) {
        CHECK(change == Approx(expected[c.model.first(k)]).margin(1e-10));
        push_joint_on_way_if(true, &tree.t, l, &v, 0.3);
        expected += 0.3 * inverse.col(c.model.first(k));
      }
      store_visit(&tree.t, l, &v);
      CHECK((six(load_motion(&tree.t, k, WORK_CHANGE)) - jacobian * expected).norm() < 1e-10);
      if (random.below(2) == 0) continue;
      const Column impulse = random_column(random, 6);
      push_on_way_if(true, &tree.t, k, force_of(impulse));
      expected += inverse * jacobian.transpose() * impulse;
      CHECK((six(load_motion(&tree.t, k, WORK_CHANGE)) - jacobian * expected).norm() < 1e-10);
    }
    end_sweep_if(true, &tree.t);
    settle_tree(&tree.t);
    CHECK((tree.get().v - c.state.v - expected).norm() < 1e-10);
  });
}

TEST_CASE("articulations: the inverse inertia of a link is J M^-1 J^T, that of a joint its entry of M^-1",
          "[articulations]")
{
  for_random_trees(true, [](Random &, const Case &c) {
    auto [tree, dense, inverse] = PreparedTree(c);
    for (uint k = 0; k < tree.t.links; ++k) {
      const auto j = dense.jacobian().middleRows<6>(6 * int(k));
      const Dense expected = j * inverse * j.transpose();
      const symmetric6 w = load_symmetric6(&tree.t, k);
      for (int i = 0; i < 6; ++i)
        CHECK((six(inverse_times(&w, force_of(Column::Unit(6, i)))) - expected.col(i)).norm() < 1e-10);
      if (c.model.freedoms(k) != 1) continue;
      const int at = c.model.first(k);
      CHECK(load_single_factor(&tree.t, tree_link_of(&tree.t, k)).response == Approx(inverse(at, at)).epsilon(1e-10));
    }
  });
}

namespace {

/* The rows of a link, for all freedoms of its tree. */
Dense path_rows(const Tree &tree, const TreeModel &model, uint k)
{
  Dense rows = Dense::Zero(model.size(), 6);
  const std::vector<int> path = model.path_of(k);
  for (uint n = 0; n < path.size(); ++n) rows.row(path[n]) = six(load_path_motion_if(1, &tree.t, k, n)).transpose();
  return rows;
}

} // namespace

TEST_CASE("articulations: rows of paths make the inverse inertia between any two links, and all that impulses do",
          "[articulations]")
{
  for_random_trees(true, [](Random &random, const Case &c) {
    auto [tree, dense, inverse] = PreparedTree(c);
    REQUIRE(tree.t.path_entries > 0);
    prepare_paths_if(1, &tree.t);
    const uint links = tree.t.links, one = random.below(links), other = random.below(links);
    const Dense rows = path_rows(tree, c.model, one), rows_of_other = path_rows(tree, c.model, other);
    const auto jacobian = [&](uint k) { return dense.jacobian().middleRows<6>(6 * int(k)); };
    const Dense expected = jacobian(one) * inverse * jacobian(other).transpose();
    CHECK((rows.transpose() * rows_of_other - expected).norm() < 1e-10 * (1 + expected.norm()));

    const Column impulse = random_column(random, 6), impulse_on_other = random_column(random, 6);
    const Column changes = rows * impulse + rows_of_other * impulse_on_other;
    tree_freedoms z;
    begin_freedoms(&tree.t, &z);
    for (int n = 0; n < changes.size(); ++n) z.change[n] = changes[n];
    leave_pending_if(1, &tree.t, &z);
    settle_if_pending(1, &tree.t);
    const Column moved =
        inverse * (jacobian(one).transpose() * impulse + jacobian(other).transpose() * impulse_on_other);
    CHECK((tree.get().v - c.state.v - moved).norm() < 1e-10 * (1 + moved.norm()));
    CHECK(tree.pending().isZero(0));
  });
}

TEST_CASE("articulations: springs and dampers are implicit in one equation of the tree", "[articulations]")
{
  for_random_trees(true, [](Random &, Case c) {
    constexpr double h = 0.02;
    for (size_t k = 0; k < c.model.links.size(); ++k)
      if (c.model.freedoms(k) == 3) c.model.links[k].stiffness = 0;
    c.model.gravity.setZero();
    Tree tree(c.model);
    tree.set(c.state);
    tree.prepare(h);
    accelerate_tree(&tree.t, zero3(), h);
    const Column now = tree.get().v;
    /* What the drives give over the substep is what they would at its end. */
    Column given = Column::Zero(c.model.size());
    for (size_t k = 0; k < c.model.links.size(); ++k) {
      const LinkModel &l = c.model.links[k];
      const int at = c.model.first(k), n = c.model.freedoms(k);
      if (n == 1)
        given[at] = -l.stiffness * (c.state.q[k][0] + h * now[at] - l.target) - l.damping * (now[at] - l.target_speed);
      if (n == 3) given.segment<3>(at) = -l.damping * now.segment<3>(at);
    }
    const Column expected = h * given;
    CHECK((DenseTree(c.model, c.state).mass_matrix() * (now - c.state.v) - expected).norm() <
          1e-10 * (1 + expected.norm()));
  });
}

TEST_CASE("articulations: trees beside each other have the bits that each has alone", "[articulations]")
{
  for_random_trees(true, [](Random &, const Case &c) {
    Tree alone(c.model), beside(c.model, 5, 3);
    alone.set(c.state);
    beside.set(c.state);
    alone.run(0.05, 5, 1);
    beside.run(0.05, 5, 1);
    CHECK(alone.get().v == beside.get().v);
    CHECK(alone.get().q == beside.get().q);
    CHECK(alone.get().root == beside.get().root);
  });
}
