/* figures.cpp - computes the figures from states of bodies; see figures.h. */
#include "tools/stability/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "host/scene/specialise.h"
#include "tools/stability/flip.h"

namespace tandem::stability {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/* The maximum of two numbers. Unlike std::max it keeps NaN. */
double larger(double a, double b) { return std::isnan(a) || std::isnan(b) ? nan : std::max(a, b); }

Figure largest(std::function<double(const Moment &, size_t body)> of)
{
  return [of = std::move(of)](const Moment &moment) {
    double worst = 0;
    const std::vector<Body> &bodies = moment.scene().bodies;
    for (size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].type == BodyType::dynamic) worst = larger(worst, of(moment, i));
    return worst;
  };
}

/* The difference of a quantity from its value at the first observed moment. */
template <typename Value, typename Compare> Figure since_start(Value value, Compare compare)
{
  using Result = decltype(value(std::declval<const Moment &>()));
  auto start = std::make_shared<std::optional<Result>>();
  return [=](const Moment &moment) {
    const Result now = value(moment);
    if (!*start) *start = now;
    return static_cast<double>(compare(**start, now));
  };
}

struct Momentum {
  Vector linear = Vector::Zero(), angular = Vector::Zero();
  double linear_scale = 0, angular_scale = 0;
};

Momentum momentum_of(const Moment &moment)
{
  Momentum sum;
  for (size_t i = 0; i < moment.bodies.size(); ++i) {
    const Body &body = moment.scene().bodies[i];
    if (body.type != BodyType::dynamic) continue;
    const BodyState &state = moment.bodies[i];
    const Vector linear = double(body.mass) * vector_of(state.linear_velocity);
    const Vector orbital = vector_of(state.position).cross(linear), spin = spin_momentum(moment.scene(), body, state);
    sum.linear += linear;
    sum.angular += orbital + spin;
    sum.linear_scale += linear.norm();
    sum.angular_scale += orbital.norm() + spin.norm();
  }
  return sum;
}

double moving_mass(const Scene &scene)
{
  double sum = 0;
  for (const Body &body : scene.bodies) sum += body.type == BodyType::dynamic ? double(body.mass) : 0.0;
  return sum;
}

double total_kinetic(const Moment &moment)
{
  double sum = 0;
  for (size_t i = 0; i < moment.bodies.size(); ++i)
    sum += kinetic_energy(moment.scene(), moment.scene().bodies[i], moment.bodies[i]);
  return sum;
}

} // namespace

Matrix axes_of(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix(); }

Quat turn_about(const Vector &axis, double angle)
{
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis.normalized()));
  return {float(q.x()), float(q.y()), float(q.z()), float(q.w())};
}

Vector moments_of(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  Vector moments;
  for (int k = 0; k < 3; ++k) moments[k] = inverse[k] > 0 ? 1.0 / inverse[k] : 0.0;
  return moments;
}

Vector spin_momentum(const Scene &scene, const Body &body, const BodyState &state)
{
  const Matrix axes = axes_of(state.orientation);
  return axes * (moments_of(scene, body).asDiagonal() * (axes.transpose() * vector_of(state.angular_velocity)));
}

double kinetic_energy(const Scene &scene, const Body &body, const BodyState &state)
{
  if (body.type != BodyType::dynamic) return 0;
  return 0.5 * double(body.mass) * vector_of(state.linear_velocity).squaredNorm() +
         0.5 * vector_of(state.angular_velocity).dot(spin_momentum(scene, body, state));
}

double mechanical_energy(const Moment &moment)
{
  double potential = 0;
  const Vector gravity = vector_of(moment.scene().gravity);
  for (size_t i = 0; i < moment.bodies.size(); ++i) {
    const Body &body = moment.scene().bodies[i];
    if (body.type == BodyType::dynamic)
      potential -= double(body.mass) * double(body.gravity_factor) * gravity.dot(vector_of(moment.bodies[i].position));
  }
  return potential + total_kinetic(moment);
}

Figure tilt(const Scene &scene)
{
  std::vector<Eigen::Quaterniond> start;
  for (const Body &body : scene.bodies)
    start.push_back(
        Eigen::Quaterniond(body.orientation[3], body.orientation[0], body.orientation[1], body.orientation[2])
            .normalized());
  return largest([start](const Moment &moment, size_t i) {
    const Quat &q = moment.bodies[i].orientation;
    const Eigen::Quaterniond turn = Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * start[i].conjugate();
    return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
  });
}

namespace {

Figure moved(const Scene &scene, bool vertical_too)
{
  std::vector<Vector> start;
  for (const Body &body : scene.bodies) start.push_back(vector_of(body.position));
  return largest([start, vertical_too](const Moment &moment, size_t i) {
    Vector displacement = vector_of(moment.bodies[i].position) - start[i];
    if (!vertical_too && std::isfinite(displacement.y())) displacement.y() = 0;
    return displacement.norm();
  });
}

} // namespace

Figure sideways(const Scene &scene) { return moved(scene, false); }
Figure displacement(const Scene &scene) { return moved(scene, true); }

Figure speed()
{
  return largest([](const Moment &moment, size_t i) { return vector_of(moment.bodies[i].linear_velocity).norm(); });
}

Figure penetration()
{
  return [](const Moment &moment) { return moment.statistics().max_penetration; };
}

Figure below(double height)
{
  return largest(
      [height](const Moment &moment, size_t i) { return larger(0, height - double(moment.bodies[i].position[1])); });
}

Figure energy_gain()
{
  return since_start(
      [](const Moment &moment) { return std::pair(mechanical_energy(moment), moving_mass(moment.scene())); },
      [](const auto &start, const auto &now) { return (now.first - start.first) / start.second; });
}

Figure kinetic_energy_drift()
{
  return since_start(total_kinetic, [](double start, double now) { return std::abs(now - start) / start; });
}

Figure linear_momentum_drift()
{
  return since_start(momentum_of, [](const Momentum &start, const Momentum &now) {
    return (now.linear - start.linear).norm() / start.linear_scale;
  });
}

Figure angular_momentum_drift()
{
  return since_start(momentum_of, [](const Momentum &start, const Momentum &now) {
    return (now.angular - start.angular).norm() / start.angular_scale;
  });
}

Figure spin_momentum_drift(uint32_t body)
{
  return since_start(
      [body](const Moment &moment) {
        return spin_momentum(moment.scene(), moment.scene().bodies[body], moment.bodies[body]);
      },
      [](const Vector &start, const Vector &now) { return (now - start).norm() / start.norm(); });
}

Figure spin_energy_drift(uint32_t body)
{
  return since_start(
      [body](const Moment &moment) {
        return vector_of(moment.bodies[body].angular_velocity)
            .dot(spin_momentum(moment.scene(), moment.scene().bodies[body], moment.bodies[body]));
      },
      [](double start, double now) { return std::abs(now - start) / start; });
}

Figure distance_from_path(uint32_t body, std::function<Vector(double time)> expected)
{
  return [body, expected = std::move(expected)](const Moment &moment) {
    return (vector_of(moment.bodies[body].position) - expected(moment.time)).norm();
  };
}

Figure flip_error(uint32_t body, double expected)
{
  auto clock = std::make_shared<FlipClock>();
  return [=](const Moment &moment) {
    const BodyState &state = moment.bodies[body];
    clock->note(moment.time, (axes_of(state.orientation).transpose() * vector_of(state.angular_velocity)).y());
    return clock->flips() < 2 ? 1.0 : std::abs(clock->interval() / expected - 1);
  };
}

} // namespace tandem::stability
