/* contact_oracle.h - small contact problems solved by brute force in double, from bodies and points alone.
 *
 * The oracle uses none of the library's solvers. J and M are written as matrices, W = J M^-1 J^T, and impulses follow
 * the projected fixed-point iteration x <- P(x - r (W x + c)), with one small step r for all rows, until nothing
 * changes. It takes a hundred thousand rounds, and is too simple to share the errors of a solver.
 *
 * Laws: normal speeds at each point, one friction cone and one twist for each manifold, at the centre of its points.
 */
#pragma once

#include <vector>

#include "tests/physics/physics.h"

namespace tandem::physics_tests {

struct OracleBody {
  double inverse_mass = 0;                 /* 0: cannot move */
  Matrix inverse_inertia = Matrix::Zero(); /* world axes */
  Vector position = Vector::Zero(), linear = Vector::Zero(), angular = Vector::Zero();
};

struct OracleManifold {
  size_t a, b;
  Vector normal;              /* from a to b */
  std::vector<Vector> points; /* world */
  double friction = 0;
  std::vector<double> target_velocity; /* m/s at least, at each point; empty: 0 */
};

struct OracleSolution {
  std::vector<OracleBody> bodies;         /* with their velocities after the impulses */
  std::vector<double> normal_impulse_sum; /* N s, sum of each manifold's normals */
  double movement = 0;                    /* of the last round, m/s: how converged it is */
};

class ContactOracle {
public:
  ContactOracle(std::vector<OracleBody> bodies, std::vector<OracleManifold> manifolds)
      : bodies_(std::move(bodies)), manifolds_(std::move(manifolds))
  {
    const auto columns = Eigen::Index(6 * bodies_.size());
    Eigen::Index rows = 0;
    for (const OracleManifold &m : manifolds_) rows += Eigen::Index(m.points.size()) + 3;
    jacobian_ = Eigen::MatrixXd::Zero(rows, columns);
    inverse_mass_ = Eigen::MatrixXd::Zero(columns, columns);
    velocity_ = Eigen::VectorXd::Zero(columns);
    target_velocity_ = Eigen::VectorXd::Zero(rows);
    for (size_t i = 0; i < bodies_.size(); ++i) {
      inverse_mass_.block<3, 3>(Eigen::Index(6 * i), Eigen::Index(6 * i)) =
          bodies_[i].inverse_mass * Matrix::Identity();
      inverse_mass_.block<3, 3>(Eigen::Index(6 * i + 3), Eigen::Index(6 * i + 3)) = bodies_[i].inverse_inertia;
      velocity_.segment<3>(Eigen::Index(6 * i)) = bodies_[i].linear;
      velocity_.segment<3>(Eigen::Index(6 * i + 3)) = bodies_[i].angular;
    }
    for (const OracleManifold &m : manifolds_) add(m);
  }

  OracleSolution solve(int most_rounds = 400000)
  {
    const Eigen::MatrixXd change = inverse_mass_ * jacobian_.transpose(), operator_ = jacobian_ * change;
    const Eigen::VectorXd free = jacobian_ * velocity_ - target_velocity_;
    const double step = 1 / operator_.norm();
    Eigen::VectorXd impulse = Eigen::VectorXd::Zero(free.size());
    OracleSolution solution;
    for (int round = 0; round < most_rounds; ++round) {
      const Eigen::VectorXd next = admitted(impulse - step * (operator_ * impulse + free));
      solution.movement = (next - impulse).norm() / step;
      impulse = next;
      if (solution.movement < 1e-13) break;
    }
    const Eigen::VectorXd velocity = velocity_ + change * impulse;
    solution.bodies = bodies_;
    for (size_t i = 0; i < bodies_.size(); ++i) {
      solution.bodies[i].linear = velocity.segment<3>(Eigen::Index(6 * i));
      solution.bodies[i].angular = velocity.segment<3>(Eigen::Index(6 * i + 3));
    }
    Eigen::Index row = 0;
    for (const OracleManifold &m : manifolds_) {
      solution.normal_impulse_sum.push_back(impulse.segment(row, Eigen::Index(m.points.size())).sum());
      row += Eigen::Index(m.points.size()) + 3;
    }
    return solution;
  }

private:
  static Vector center_of(const OracleManifold &m)
  {
    Vector sum = Vector::Zero();
    for (const Vector &point : m.points) sum += point;
    return sum / double(m.points.size());
  }

  void set_row(Eigen::Index row, const OracleManifold &m, const Vector &at, const Vector &along)
  {
    for (const bool second : {false, true}) {
      const auto body = Eigen::Index(second ? m.b : m.a);
      const double sign = second ? 1 : -1;
      const Vector turn = (at - bodies_[size_t(body)].position).cross(along);
      for (int k = 0; k < 3; ++k) {
        jacobian_(row, 6 * body + k) += sign * along[k];
        jacobian_(row, 6 * body + 3 + k) += sign * turn[k];
      }
    }
  }

  void add(const OracleManifold &m)
  {
    for (size_t k = 0; k < m.points.size(); ++k) {
      set_row(row_, m, m.points[k], m.normal);
      if (!m.target_velocity.empty()) target_velocity_[row_] = m.target_velocity[k];
      ++row_;
    }
    const Vector first = m.normal.unitOrthogonal(), second = m.normal.cross(first);
    set_row(row_++, m, center_of(m), first);
    set_row(row_++, m, center_of(m), second);
    for (int k = 0; k < 3; ++k) {
      jacobian_(row_, Eigen::Index(6 * m.a) + 3 + k) -= m.normal[k];
      jacobian_(row_, Eigen::Index(6 * m.b) + 3 + k) += m.normal[k];
    }
    ++row_;
  }

  static double twist_radius(const OracleManifold &m)
  {
    double sum = 0;
    for (const Vector &point : m.points) sum += (point - center_of(m)).norm();
    return sum / double(m.points.size());
  }

  Eigen::VectorXd admitted(Eigen::VectorXd x) const
  {
    Eigen::Index row = 0;
    for (const OracleManifold &m : manifolds_) {
      const auto points = Eigen::Index(m.points.size());
      x.segment(row, points) = x.segment(row, points).cwiseMax(0.0);
      const double limit = m.friction * x.segment(row, points).sum();
      const double slide = x.segment<2>(row + points).norm();
      if (slide > limit) x.segment<2>(row + points) *= limit / slide;
      x[row + points + 2] = std::clamp(x[row + points + 2], -limit * twist_radius(m), limit * twist_radius(m));
      row += points + 3;
    }
    return x;
  }

  std::vector<OracleBody> bodies_;
  std::vector<OracleManifold> manifolds_;
  Eigen::MatrixXd jacobian_, inverse_mass_;
  Eigen::VectorXd velocity_, target_velocity_;
  Eigen::Index row_ = 0;
};

/* The bodies of a scene when the contacts of a step of `h` seconds are solved, with gravity applied. */
inline std::vector<OracleBody> oracle_bodies(const Scene &scene, double h)
{
  std::vector<OracleBody> bodies;
  for (const Body &body : scene.bodies) {
    OracleBody one;
    one.position = vector_of(body.position);
    one.linear = vector_of(body.linear_velocity);
    one.angular = vector_of(body.angular_velocity);
    if (body.type == BodyType::dynamic) {
      const Matrix axes = axes_of(body.orientation);
      one.inverse_mass = 1.0 / body.mass;
      one.inverse_inertia = axes * vector_of(inverse_inertia_of(scene, body)).asDiagonal() * axes.transpose();
      one.linear += h * vector_of(scene.gravity);
    }
    bodies.push_back(one);
  }
  return bodies;
}

/* The corners of the lower face of a box (along `down` in the body's axes: 1 is y), as its contact with the body below
 * has them. */
inline OracleManifold box_on_face(const Scene &scene, size_t below, size_t box, double friction)
{
  const Body &body = scene.bodies[box];
  const Matrix axes = axes_of(body.orientation);
  const Vec3 &size = scene.shapes[body.shape].size;
  OracleManifold m{below, box, axes.col(1), {}, friction, {}};
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0})
      m.points.push_back(vector_of(body.position) + axes * Vector(x * size[0], -size[1], z * size[2]));
  return m;
}

} // namespace tandem::physics_tests
