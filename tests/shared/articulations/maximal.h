/* maximal.h - the accelerations of the links of a tree in maximal coordinates, for the tests of articulations:
 *
 *      | M  -G^T | | accelerations |   | forces                     |
 *      | G   0   | | held forces   | = | -what velocities change G v by |
 *
 * The rows of G hold directions and rotations of frame b in axes of frame a. */
#pragma once

#include "tests/shared/articulations/tree_model.h"

namespace tandem::tree_tests {

class MaximalTree {
public:
  MaximalTree(const TreeModel &model, const TreeState &state) : model_(model), state_(state), dense_(model, state) {}

  Column accelerations(const Column &joint_forces, const Column &outer) const
  {
    constexpr double e = 1e-5;
    const Dense g = rows(state_);
    const Dense change = (8 * (rows(moved(model_, state_, e)) - rows(moved(model_, state_, -e))) -
                          (rows(moved(model_, state_, 2 * e)) - rows(moved(model_, state_, -2 * e)))) /
                         (12 * e);
    const int n = int(g.cols()), held = int(g.rows());
    Dense k = Dense::Zero(n + held, n + held);
    k.topLeftCorner(n, n) = dense_.masses();
    k.topRightCorner(n, held) = -g.transpose();
    k.bottomLeftCorner(held, n) = g;
    Column right(n + held);
    right.head(n) = outer + dense_.forces(model_.gravity) + forces_of_joints(joint_forces);
    right.tail(held) = -change * dense_.velocities();
    return k.partialPivLu().solve(right).head(n);
  }

private:
  /* Of the velocities of frame b relative to frame a: along `direction`, and about it. */
  void add_point_row(Eigen::RowVectorXd &row, const DenseTree &d, size_t k, const Vector &direction) const
  {
    add_side(row, d, int(k), d.poses()[k].anchor, direction, 1);
    add_side(row, d, model_.links[k].parent, d.poses()[k].anchor, direction, -1);
  }
  static void add_side(Eigen::RowVectorXd &row, const DenseTree &d, int link, const Vector &at, const Vector &n,
                       double sign)
  {
    if (link < 0) return;
    row.segment<3>(6 * link) += sign * (at - d.poses()[size_t(link)].center).cross(n).transpose();
    row.segment<3>(6 * link + 3) += sign * n.transpose();
  }
  void add_turn_row(Eigen::RowVectorXd &row, size_t k, const Vector &n) const
  {
    row.segment<3>(6 * int(k)) += n.transpose();
    if (model_.links[k].parent >= 0) row.segment<3>(6 * model_.links[k].parent) -= n.transpose();
  }

  Dense rows(const TreeState &state) const
  {
    const DenseTree d(model_, state);
    std::vector<Eigen::RowVectorXd> all;
    const int size = 6 * int(state.q.size());
    for (size_t k = 0; k < state.q.size(); ++k) {
      const int joint = model_.links[k].joint;
      const Eigen::Matrix3d axes = d.poses()[k].frame_a.toRotationMatrix();
      for (int i = 0; i < 3 && joint != TREE_JOINT_FREE; ++i)
        if (joint != TREE_JOINT_SLIDER || i > 0)
          add_point_row(all.emplace_back(Eigen::RowVectorXd::Zero(size)), d, k, axes.col(i));
      for (int i = 0; i < 3 && joint != TREE_JOINT_FREE && joint != TREE_JOINT_BALL; ++i)
        if (joint != TREE_JOINT_HINGE || i > 0)
          add_turn_row(all.emplace_back(Eigen::RowVectorXd::Zero(size)), k, axes.col(i));
    }
    Dense g(int(all.size()), size);
    for (size_t i = 0; i < all.size(); ++i) g.row(int(i)) = all[i];
    return g;
  }

  Column forces_of_joints(const Column &numbers) const
  {
    Eigen::RowVectorXd f = Eigen::RowVectorXd::Zero(6 * int(state_.q.size()));
    for (size_t k = 0; k < state_.q.size(); ++k) {
      const int first = model_.first(k), joint = model_.links[k].joint;
      const Eigen::Matrix3d axes = dense_.poses()[k].frame_a.toRotationMatrix();
      if (joint == TREE_JOINT_HINGE) add_turn_row(f, k, numbers[first] * axes.col(0));
      if (joint == TREE_JOINT_SLIDER) add_point_row(f, dense_, k, numbers[first] * axes.col(0));
      if (joint == TREE_JOINT_BALL) add_turn_row(f, k, axes * numbers.segment<3>(first));
      if (joint == TREE_JOINT_FREE) f.segment<6>(6 * int(k)) += numbers.segment<6>(first).transpose();
    }
    return f.transpose();
  }

  const TreeModel &model_;
  const TreeState state_;
  const DenseTree dense_;
};

} // namespace tandem::tree_tests
