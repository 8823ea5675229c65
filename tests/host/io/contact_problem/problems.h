/* problems.h - an oracle for frictional contact problems: dense, in double, independent of shared/. */
#pragma once

#include <Eigen/Dense>

#include "host/io/contact_problem/file.h"

namespace tandem {

struct DenseProblem {
  Eigen::MatrixXd delassus;
  Eigen::VectorXd free_velocity;
  std::vector<double> friction;

  explicit DenseProblem(const ContactProblem &problem)
      : delassus(Eigen::MatrixXd::Zero(3 * problem.contacts, 3 * problem.contacts)),
        free_velocity(3 * problem.contacts), friction(problem.friction)
  {
    for (uint32_t i = 0; i < problem.contacts; ++i) {
      for (uint32_t k = problem.start[i]; k < problem.start[i + 1]; ++k)
        for (int c = 0; c < 9; ++c)
          delassus(3 * i + c / 3, 3 * problem.column[k] + c % 3) = problem.blocks[k][static_cast<size_t>(c)];
      for (int axis = 0; axis < 3; ++axis)
        free_velocity[3 * i + axis] = problem.free_velocity[i][static_cast<size_t>(axis)];
    }
  }

  /* The nearest point of the cone, from its two extreme rays in the plane of v and the axis instead of one formula for
   * both. */
  static Eigen::Vector3d nearest(const Eigen::Vector3d &v, double mu)
  {
    const Eigen::Vector2d tangent =
        v.tail<2>().norm() > 0 ? Eigen::Vector2d(v.tail<2>().normalized()) : Eigen::Vector2d(1, 0);
    const Eigen::Vector3d ray = Eigen::Vector3d(1, mu * tangent[0], mu * tangent[1]).normalized();
    if (v.tail<2>().norm() <= mu * v[0]) return v;
    return std::max(0.0, ray.dot(v)) * ray;
  }

  Eigen::VectorXd corrected(Eigen::VectorXd velocity) const
  {
    for (size_t i = 0; i < friction.size(); ++i)
      velocity[static_cast<int>(3 * i)] += friction[i] * velocity.segment<2>(static_cast<int>(3 * i) + 1).norm();
    return velocity;
  }
  Eigen::VectorXd velocity(const Eigen::VectorXd &r) const { return delassus * r + free_velocity; }

  Eigen::VectorXd projected(Eigen::VectorXd v) const
  {
    for (size_t i = 0; i < friction.size(); ++i)
      v.segment<3>(static_cast<int>(3 * i)) = nearest(v.segment<3>(static_cast<int>(3 * i)), friction[i]);
    return v;
  }

  /* The residual of docs/contact-problems.md, in one line. */
  double natural_residual(const Eigen::VectorXd &r) const
  {
    const double rho = 10 / (delassus.trace() / static_cast<double>(free_velocity.size()));
    return (r - projected(r - rho * corrected(velocity(r)))).norm() / (rho * corrected(free_velocity).norm());
  }

  /* Moves all impulses at once along the corrected velocity, with a step below the operator's. This is slow and not
   * related to Gauss-Seidel. */
  Eigen::VectorXd fixed_point(int steps = 20000) const
  {
    const double rho = 0.5 / delassus.norm();
    Eigen::VectorXd r = Eigen::VectorXd::Zero(free_velocity.size());
    for (int k = 0; k < steps; ++k) r = projected(r - rho * corrected(velocity(r)));
    return r;
  }
};

inline Eigen::VectorXd vector_of(const std::vector<std::array<double, 3>> &rows)
{
  Eigen::VectorXd v(3 * rows.size());
  for (size_t i = 0; i < rows.size(); ++i)
    for (size_t axis = 0; axis < 3; ++axis) v[static_cast<int>(3 * i + axis)] = rows[i][axis];
  return v;
}

} // namespace tandem
