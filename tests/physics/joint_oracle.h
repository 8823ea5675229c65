/* joint_oracle.h - the motion of bodies with joints, computed in double by another way than Tandem's: accelerations
 * from the equations of motion with exact constraints, integrated by the rule of Runge and Kutta of fourth order.
 *
 * Unknown are all accelerations and the forces of all locked rows (maximal coordinates):
 *
 *      | M  J^T | | acceleration |   | forces                  |
 *      | J   0  | | -forces      | = | -what velocities make J v change by |
 *
 * Rows are written in axes n of frame a, which turn with body a. Of a locked direction with d from frame a to frame b,
 * the second derivative of n . d is 0; of a locked rotation, that of the relative angular velocity along n. */
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "tests/physics/joints.h"

namespace tandem::physics_tests {

class JointOracle {
public:
  struct State {
    Vector position, velocity, spin; /* spin: the angular velocity in the world */
    Eigen::Quaterniond turn;
  };

  explicit JointOracle(const Scene &scene) : scene_(scene)
  {
    for (const Body &body : scene.bodies) {
      states_.push_back({vector_of(body.position), vector_of(body.linear_velocity), vector_of(body.angular_velocity),
                         eigen_of(body.orientation)});
      moments_.push_back(moments_of(scene, body));
    }
  }

  void run(double time, int steps)
  {
    for (int k = 0; k < steps; ++k) step(time / steps);
  }
  const std::vector<State> &states() const { return states_; }

  /* The largest distance between the centre of a body and where the world has it, m. */
  double distance_to(World &world) const
  {
    const PreciseBodies bodies = world.precise_bodies();
    double distance = 0;
    for (size_t i = 0; i < states_.size(); ++i)
      distance = std::max(distance, (Vector(bodies[i].position.data()) - states_[i].position).norm());
    return distance;
  }
  /* The same of orientations, rad. */
  double angle_to(World &world) const
  {
    const PreciseBodies bodies = world.precise_bodies();
    double angle = 0;
    for (size_t i = 0; i < states_.size(); ++i) {
      const auto &q = states_[i].turn;
      angle = std::max(angle, angle_between({q.x(), q.y(), q.z(), q.w()}, bodies[i].orientation));
    }
    return angle;
  }

private:
  using Dense = Eigen::MatrixXd;
  using Column = Eigen::VectorXd;

  /* Which directions and rotations each type locks, by the definitions of docs/joints.md. */
  struct Locks {
    std::array<bool, 3> directions, rotations;
  };
  static Locks locks_of(JointType type)
  {
    switch (type) {
    case JointType::ball: return {{true, true, true}, {false, false, false}};
    case JointType::fixed: return {{true, true, true}, {true, true, true}};
    case JointType::hinge: return {{true, true, true}, {false, true, true}};
    case JointType::slider: return {{false, true, true}, {true, true, true}};
    case JointType::cylindrical: return {{false, true, true}, {false, true, true}};
    case JointType::plane: return {{true, false, false}, {false, true, true}};
    case JointType::parallel: return {{false, false, false}, {false, true, true}};
    default: throw std::logic_error("the oracle does not know joints of type " + name_of_type(type));
    }
  }

  /* A side of a joint now; arm: from the centre of the body to its frame. */
  struct Side {
    int column; /* of the body's unknowns; -1: it is not pushed */
    Vector arm, origin, velocity, spin;
    Eigen::Quaterniond axes;
  };
  Side side_of(const std::vector<State> &states, uint32_t body, const Point &position, const Quat &orientation) const
  {
    const Vector local = vector_of(position);
    if (body == no_body) return {-1, Vector::Zero(), local, Vector::Zero(), Vector::Zero(), eigen_of(orientation)};
    const State &s = states[body];
    const Vector arm = s.turn * local;
    const int column = scene_.bodies[body].type == BodyType::dynamic ? 6 * int(body) : -1;
    return {column, arm, s.position + arm, s.velocity, s.spin, s.turn * eigen_of(orientation)};
  }

  struct Rows {
    std::vector<Column> jacobian;
    std::vector<double> right;
    void add(const Side &side, const Vector &linear, const Vector &angular)
    {
      if (side.column < 0) return;
      jacobian.back().segment<3>(side.column) += linear;
      jacobian.back().segment<3>(side.column + 3) += angular;
    }
  };

  static void add_direction(Rows &rows, const Side &a, const Side &b, const Vector &n)
  {
    const Vector d = b.origin - a.origin;
    const Vector rate = b.velocity + b.spin.cross(b.arm) - a.velocity - a.spin.cross(a.arm);
    rows.add(a, -n, -(a.arm + d).cross(n));
    rows.add(b, n, b.arm.cross(n));
    const Vector turning = b.spin.cross(b.spin.cross(b.arm)) - a.spin.cross(a.spin.cross(a.arm));
    rows.right.push_back(-(n.dot(turning) + 2 * a.spin.cross(n).dot(rate) + a.spin.cross(a.spin.cross(n)).dot(d)));
  }
  static void add_rotation(Rows &rows, const Side &a, const Side &b, const Vector &n)
  {
    rows.add(a, Vector::Zero(), -n);
    rows.add(b, Vector::Zero(), n);
    rows.right.push_back(-(b.spin - a.spin).dot(a.spin.cross(n)));
  }

  Rows rows_of(const std::vector<State> &states) const
  {
    Rows rows;
    for (const Joint &joint : scene_.joints) {
      const Side a = side_of(states, joint.body_a, joint.position_a, joint.orientation_a),
                 b = side_of(states, joint.body_b, joint.position_b, joint.orientation_b);
      const Locks locks = locks_of(joint.type);
      for (size_t k = 0; k < 6; ++k) {
        if (!(k < 3 ? locks.directions[k] : locks.rotations[k - 3])) continue;
        rows.jacobian.push_back(Column::Zero(6 * int(scene_.bodies.size())));
        const Vector n = a.axes * Vector(Vector::Unit(int(k % 3)));
        if (k < 3) add_direction(rows, a, b, n);
        else add_rotation(rows, a, b, n);
      }
    }
    return rows;
  }

  /* Linear and angular accelerations, six numbers a body. */
  Column accelerations(const std::vector<State> &states) const
  {
    const int n = 6 * int(states.size());
    Column free = Column::Zero(n);
    Dense inverse_mass = Dense::Zero(n, n);
    for (size_t i = 0; i < states.size(); ++i) {
      const Body &body = scene_.bodies[i];
      if (body.type != BodyType::dynamic) continue;
      const Matrix axes = states[i].turn.toRotationMatrix();
      const Matrix inertia = axes * moments_[i].asDiagonal() * axes.transpose();
      const Matrix inverse = axes * moments_[i].cwiseInverse().asDiagonal() * axes.transpose();
      const int at = 6 * int(i);
      inverse_mass.block<3, 3>(at, at) = Matrix::Identity() / double(body.mass);
      inverse_mass.block<3, 3>(at + 3, at + 3) = inverse;
      free.segment<3>(at) = vector_of(scene_.gravity);
      free.segment<3>(at + 3) = -inverse * states[i].spin.cross(inertia * states[i].spin);
    }
    const Rows rows = rows_of(states);
    if (rows.jacobian.empty()) return free;
    Dense jacobian(int(rows.jacobian.size()), n);
    for (int r = 0; r < jacobian.rows(); ++r) jacobian.row(r) = rows.jacobian[size_t(r)].transpose();
    const Column right = Eigen::Map<const Column>(rows.right.data(), int(rows.right.size()));
    const Dense response = inverse_mass * jacobian.transpose();
    const Column forces = (jacobian * response).ldlt().solve(right - jacobian * free);
    return free + response * forces;
  }

  /* The derivative of the orientation is that at the stage, so its stages are added as the other ones are. */
  void step(double h)
  {
    constexpr double weights[] = {1, 2, 2, 1}, ways[] = {0, 0.5, 0.5, 1};
    std::vector<State> at = states_, next = states_;
    for (int stage = 0; stage < 4; ++stage) {
      const Column a = accelerations(at);
      std::vector<State> ahead = states_;
      for (size_t i = 0; i < at.size(); ++i) {
        const double share = h * weights[stage] / 6, way = stage < 3 ? h * ways[stage + 1] : 0;
        const Vector linear = a.segment<3>(6 * int(i)), angular = a.segment<3>(6 * int(i) + 3);
        const Eigen::Quaterniond rate =
            Eigen::Quaterniond(0, at[i].spin.x(), at[i].spin.y(), at[i].spin.z()) * at[i].turn;
        advance(next[i], share, at[i], linear, angular, rate);
        advance(ahead[i], way, at[i], linear, angular, rate);
        ahead[i].turn.normalize();
      }
      at = ahead;
    }
    for (State &s : next) s.turn.normalize();
    states_ = next;
  }
  static void advance(State &s, double h, const State &at, const Vector &linear, const Vector &angular,
                      const Eigen::Quaterniond &rate)
  {
    s.position += h * at.velocity;
    s.velocity += h * linear;
    s.spin += h * angular;
    s.turn.coeffs() += 0.5 * h * rate.coeffs();
  }

  const Scene &scene_;
  std::vector<State> states_;
  std::vector<Vector> moments_;
};

} // namespace tandem::physics_tests
