/* tree_model.h - trees for the tests of articulations, and their mechanics as dense matrices in double precision.
 *
 * The oracle shares nothing with shared/articulations/: poses are products of Eigen's rotations; the Jacobian J of all
 * links is built from axes and arms; M = J^T diag(m, I) J; and what J changes by while a tree moves is a difference of
 * J between two moments. Numbers of velocities stand link by link, as joint_types.h has them.
 */
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "host/base/random.h"
#include "shared/articulations/joint_types.h"

namespace tandem::tree_tests {

using Vector = Eigen::Vector3d;
using Turn = Eigen::Quaterniond;
using Column = Eigen::VectorXd;
using Dense = Eigen::MatrixXd;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct LinkModel {
  int parent = -1;
  int joint = TREE_JOINT_HINGE;
  Vector from_parent = Vector::Zero(), from_center = Vector::Zero(); /* to frame a and to frame b, in own axes */
  Turn axes_in_parent = Turn::Identity(), axes_in_link = Turn::Identity();
  double mass = 1;
  Vector moments = Vector::Ones();
  double armature = 0, lower = -infinite, upper = infinite, target = 0, target_speed = 0, stiffness = 0, damping = 0,
         largest_force = infinite, friction = 0;
};

struct TreeModel {
  std::vector<LinkModel> links;
  Vector gravity{0, -10, 0};

  int freedoms(size_t k) const
  {
    constexpr int of_joint[] = {0, 1, 1, 3, 6};
    return of_joint[links[k].joint];
  }
  int first(size_t k) const
  {
    int sum = 0;
    for (size_t i = 0; i < k; ++i) sum += freedoms(i);
    return sum;
  }
  int size() const { return first(links.size()); }
  /* The freedoms of the joints from the root to link k, in order. */
  std::vector<int> path_of(size_t k) const
  {
    std::vector<int> path;
    if (links[k].parent >= 0) path = path_of(size_t(links[k].parent));
    for (int n = 0; n < freedoms(k); ++n) path.push_back(first(k) + n);
    return path;
  }
};

struct TreeState {
  std::vector<Eigen::Vector4d> q; /* x, or a quaternion x y z w */
  Vector root = Vector::Zero();
  Column v;
};

inline TreeState rest_of(const TreeModel &model)
{
  TreeState s;
  s.q.assign(model.links.size(), Eigen::Vector4d(0, 0, 0, 0));
  for (size_t k = 0; k < s.q.size(); ++k)
    if (model.freedoms(k) >= 3) s.q[k][3] = 1;
  s.v = Column::Zero(model.size());
  return s;
}

inline Turn rotation_by(const Vector &v)
{
  const double angle = v.norm();
  return angle < 1e-300 ? Turn::Identity() : Turn(Eigen::AngleAxisd(angle, v / angle));
}
inline Turn turn_of(const Eigen::Vector4d &q) { return Turn(q[3], q[0], q[1], q[2]); }

/* The state after h at unchanged velocities. */
inline TreeState moved(const TreeModel &model, TreeState s, double h)
{
  for (size_t k = 0; k < s.q.size(); ++k) {
    const int first = model.first(k), n = model.freedoms(k);
    if (n == 1) s.q[k][0] += h * s.v[first];
    if (n >= 3) s.q[k] = (rotation_by(h * Vector(s.v.segment<3>(first))) * turn_of(s.q[k])).normalized().coeffs();
    if (n == 6) s.root += h * s.v.segment<3>(first + 3);
  }
  return s;
}

class DenseTree {
public:
  struct Pose {
    Vector center, anchor; /* anchor: of frame b */
    Turn turn, frame_a;
  };

  DenseTree(const TreeModel &model, const TreeState &state) : model_(model), state_(state)
  {
    for (size_t k = 0; k < model.links.size(); ++k) poses_.push_back(pose(k));
    jacobian_ = Dense::Zero(6 * int(model.links.size()), model.size());
    for (size_t k = 0; k < model.links.size(); ++k)
      for (int i = int(k); i >= 0; i = model.links[size_t(i)].parent)
        for (int n = 0; n < model.freedoms(size_t(i)); ++n)
          jacobian_.block<6, 1>(6 * int(k), model.first(size_t(i)) + n) = motion_of(size_t(i), n, poses_[k].center);
  }

  const std::vector<Pose> &poses() const { return poses_; }
  /* Of all links: angular, linear velocity of the centre. */
  const Dense &jacobian() const { return jacobian_; }
  Dense jacobian_of(size_t link, const Vector &point) const
  {
    Dense j = jacobian_.middleRows<6>(6 * int(link));
    const Vector arm = point - poses_[link].center;
    for (int c = 0; c < j.cols(); ++c) j.block<3, 1>(3, c) += Vector(j.block<3, 1>(0, c)).cross(arm);
    return j;
  }

  Eigen::Matrix3d inertia(size_t k) const
  {
    const Eigen::Matrix3d r = poses_[k].turn.toRotationMatrix();
    return r * model_.links[k].moments.asDiagonal() * r.transpose();
  }
  Dense masses() const
  {
    const int n = int(poses_.size());
    Dense m = Dense::Zero(6 * n, 6 * n);
    for (int k = 0; k < n; ++k) {
      m.block<3, 3>(6 * k, 6 * k) = inertia(size_t(k));
      m.block<3, 3>(6 * k + 3, 6 * k + 3) = model_.links[size_t(k)].mass * Eigen::Matrix3d::Identity();
    }
    return m;
  }
  /* With armature, and with the implicit parts of drives over h. */
  Dense mass_matrix(double h = 0) const
  {
    Dense m = jacobian_.transpose() * masses() * jacobian_;
    for (size_t k = 0; k < poses_.size(); ++k)
      for (int n = 0; n < model_.freedoms(k) && n < 3 && model_.freedoms(k) != 6; ++n) {
        const LinkModel &l = model_.links[k];
        m(model_.first(k) + n, model_.first(k) + n) += l.armature + h * (l.damping + h * l.stiffness);
      }
    return m;
  }
  Column velocities() const { return jacobian_ * state_.v; }

  /* What pushes the links: gravity, and the moments against turning of uneven bodies. */
  Column forces(const Vector &gravity) const
  {
    const Column v = velocities();
    Column f = Column::Zero(v.size());
    for (int k = 0; k < int(poses_.size()); ++k) {
      const Vector w = v.segment<3>(6 * k);
      f.segment<3>(6 * k) = -w.cross(inertia(size_t(k)) * w);
      f.segment<3>(6 * k + 3) = model_.links[size_t(k)].mass * gravity;
    }
    return f;
  }
  /* The accelerations of the links while the velocities of the joints stay. */
  Column bias() const
  {
    constexpr double e = 1e-5;
    const auto at = [&](double t) { return DenseTree(model_, moved(model_, state_, t)).velocities(); };
    return (8 * (at(e) - at(-e)) - (at(2 * e) - at(-2 * e))) / (12 * e);
  }
  Column acceleration(const Column &joint_forces, const Column &outer) const
  {
    const Column f = outer + forces(model_.gravity) - masses() * bias();
    return mass_matrix().ldlt().solve(joint_forces + jacobian_.transpose() * f);
  }

  double kinetic_energy() const { return 0.5 * state_.v.dot(mass_matrix() * state_.v); }
  double potential_energy() const
  {
    double sum = 0;
    for (size_t k = 0; k < poses_.size(); ++k) sum -= model_.links[k].mass * model_.gravity.dot(poses_[k].center);
    return sum;
  }
  /* Linear, and angular about the origin. */
  std::array<Vector, 2> momentum() const
  {
    const Column p = masses() * velocities();
    std::array<Vector, 2> sum{Vector::Zero(), Vector::Zero()};
    for (int k = 0; k < int(poses_.size()); ++k) {
      sum[0] += p.segment<3>(6 * k + 3);
      sum[1] += p.segment<3>(6 * k) + poses_[size_t(k)].center.cross(Vector(p.segment<3>(6 * k + 3)));
    }
    return sum;
  }

private:
  Pose pose(size_t k) const
  {
    const LinkModel &l = model_.links[k];
    const bool is_root = l.parent < 0;
    const Turn parent = is_root ? Turn::Identity() : poses_[size_t(l.parent)].turn;
    const Vector center = is_root ? state_.root : poses_[size_t(l.parent)].center;
    Pose p;
    p.frame_a = parent * l.axes_in_parent;
    p.anchor = center + parent * l.from_parent;
    Turn joint = Turn::Identity();
    if (l.joint == TREE_JOINT_HINGE) joint = rotation_by(Vector(state_.q[k][0], 0, 0));
    if (l.joint == TREE_JOINT_SLIDER) p.anchor += p.frame_a * Vector(state_.q[k][0], 0, 0);
    if (model_.freedoms(k) >= 3) joint = turn_of(state_.q[k]);
    p.turn = p.frame_a * joint * l.axes_in_link.conjugate();
    p.center = p.anchor - p.turn * l.from_center;
    return p;
  }
  Eigen::Matrix<double, 6, 1> motion_of(size_t joint, int number, const Vector &point) const
  {
    const Pose &p = poses_[joint];
    const int kind = model_.links[joint].joint;
    Vector axis = Vector::Unit(number % 3);
    if (kind != TREE_JOINT_FREE) axis = p.frame_a * axis;
    Eigen::Matrix<double, 6, 1> m;
    if (kind == TREE_JOINT_SLIDER || number >= 3) m << Vector::Zero(), axis;
    else m << axis, axis.cross(point - p.anchor);
    return m;
  }

  const TreeModel &model_;
  const TreeState state_;
  std::vector<Pose> poses_;
  Dense jacobian_;
};

/* --- trees and states ------------------------------------------------------------------------------------------ */
inline Vector random_vector(Random &random, double size)
{
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}
inline Turn random_turn(Random &random)
{
  const auto q = random.orientation();
  return Turn(q[3], q[0], q[1], q[2]).normalized();
}

/* Links of random masses, moments and frames, each on the one before or on a random one between it and the root
 * (shared/articulations/tree.h has the order). Numbers are floats, so that both precisions have the same tree. */
inline TreeModel random_tree(Random &random, size_t count, int root)
{
  TreeModel model;
  const auto number = [&](double low, double high) { return double(float(random.uniform(low, high))); };
  for (size_t k = 0; k < count; ++k) {
    LinkModel l;
    l.parent = int(k) - 1;
    for (uint32_t up = k == 0 ? 0 : random.below(4); up > 0 && l.parent > 0; --up)
      l.parent = model.links[size_t(l.parent)].parent;
    l.joint = k == 0 ? root : int(random.below(4));
    const bool is_free = l.joint == TREE_JOINT_FREE;
    if (k > 0) l.from_parent = random_vector(random, 0.4).cast<float>().cast<double>();
    if (!is_free) {
      l.from_center = random_vector(random, 0.4).cast<float>().cast<double>();
      l.axes_in_parent = random_turn(random);
      l.axes_in_link = random_turn(random);
    }
    l.mass = number(0.5, 3);
    const Vector sides(number(0.1, 0.6), number(0.1, 0.6), number(0.1, 0.6));
    l.moments = l.mass / 3 * (Vector::Constant(sides.squaredNorm()) - sides.cwiseAbs2());
    l.moments = l.moments.cast<float>().cast<double>();
    model.links.push_back(l);
  }
  return model;
}
inline TreeState random_state(Random &random, const TreeModel &model, double speed)
{
  TreeState s = rest_of(model);
  for (size_t k = 0; k < s.q.size(); ++k) {
    if (model.freedoms(k) == 1) s.q[k][0] = random.uniform(-1.5, 1.5);
    if (model.freedoms(k) >= 3) s.q[k] = random_turn(random).coeffs();
  }
  if (model.links[0].joint == TREE_JOINT_FREE) s.root = random_vector(random, 2);
  for (int i = 0; i < s.v.size(); ++i) s.v[i] = random.uniform(-speed, speed);
  return s;
}

} // namespace tandem::tree_tests
