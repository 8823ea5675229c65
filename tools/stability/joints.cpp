/* joints.cpp - places joints and reads their figures; see joints.h. */
#include "tools/stability/joints.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <tandem/metrics.h>

namespace tandem::stability {
namespace {

/* The turn of the axis x to a direction. */
Eigen::Quaterniond turn_of_x_to(const Vector &direction)
{
  return Eigen::Quaterniond::FromTwoVectors(Vector::UnitX(), direction);
}

void place_frame(const Scene &scene, uint32_t body, const Vector &at, const Eigen::Quaterniond &axes, Point &position,
                 Quat &orientation)
{
  Vector centre = Vector::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (body != no_body) {
    centre = vector_of(scene.bodies[body].position);
    turn = eigen_of(scene.bodies[body].orientation);
  }
  const Eigen::Quaterniond q = turn.conjugate() * axes;
  position = point_of(turn.conjugate() * (at - centre));
  orientation = {float(q.x()), float(q.y()), float(q.z()), float(q.w())};
}

std::vector<JointError> errors_of(const Moment &moment)
{
  return joint_errors(moment.scene(), moment.world.precise_bodies());
}

/* The largest of what a moment has many of; NaN is kept. */
template <typename Range, typename Of> double largest_of(const Range &range, Of of)
{
  double worst = 0;
  for (const auto &each : range) {
    const double value = of(each);
    if (value > worst || std::isnan(value)) worst = value;
  }
  return worst;
}

Vector at_of(const PreciseBodyState &state) { return Vector(state.position.data()); }

} // namespace

Joint &connect(Scene &scene, JointType type, uint32_t a, uint32_t b, const Vector &at, const Eigen::Quaterniond &axes)
{
  Joint joint;
  joint.type = type;
  joint.body_a = a;
  joint.body_b = b;
  place_frame(scene, a, at, axes, joint.position_a, joint.orientation_a);
  place_frame(scene, b, at, axes, joint.position_b, joint.orientation_b);
  return scene.joints.emplace_back(joint);
}

Joint &connect(Scene &scene, JointType type, uint32_t a, uint32_t b, const Vector &at, const Vector &axis)
{
  return connect(scene, type, a, b, at, turn_of_x_to(axis));
}

void let_pass(Scene &scene)
{
  for (Body &body : scene.bodies) body.filter_mask = 0;
}

Settings with_stiff_joints(uint32_t substeps)
{
  Settings settings = with_substeps(substeps);
  settings.joint_hertz = 15.0f * float(substeps);
  return settings;
}

JointSoftness::JointSoftness(const Settings &settings)
{
  const double h = double(settings.step) / settings.substeps,
               w = 2 * pi * joint_hertz_of(settings),
               rate = w / (2 * double(settings.joint_damping_ratio) + h * w);
  stretch = 1 / (w * w);
  open = stretch + 0.5 * h / rate;
}

Figure joint_opening()
{
  return [](const Moment &moment) {
    return largest_of(errors_of(moment), [](const JointError &error) { return error.distance; });
  };
}

Figure mean_joint_opening()
{
  return [](const Moment &moment) { return summary_of(errors_of(moment)).mean_distance; };
}

Figure joint_angle()
{
  return [](const Moment &moment) {
    return largest_of(errors_of(moment), [](const JointError &error) { return error.angle; });
  };
}

Figure coupling_slack()
{
  return [](const Moment &moment) {
    return largest_of(coupling_errors(moment.scene(), moment.world.precise_bodies()),
                      [](double error) { return std::abs(error); });
  };
}

Figure stretch_to(uint32_t body, const Vector &from, double length)
{
  return [=](const Moment &moment) {
    const double stretch = (at_of(moment.world.precise_bodies()[body]) - from).norm() / length - 1;
    return std::isnan(stretch) ? stretch : std::max(0.0, stretch);
  };
}

Figure beyond_limit(uint32_t joint, size_t coordinate, double limit)
{
  return [=](const Moment &moment) {
    const JointReading reading = moment.world.read_joint(moment.world.id_of_joint(joint));
    const double value = coordinate < 3 ? reading.directions[coordinate] : reading.rotations[coordinate - 3];
    return std::isnan(value) ? value : std::max(0.0, value - limit);
  };
}

Figure relative_energy_gain(const Scene &scene, double scale)
{
  double mass = 0;
  for (const Body &body : scene.bodies) mass += body.type == BodyType::dynamic ? double(body.mass) : 0.0;
  return [gain = energy_gain(), factor = mass / scale](const Moment &moment) { return factor * gain(moment); };
}

Figure mechanical_energy_drift()
{
  auto start = std::make_shared<std::optional<double>>();
  return [start](const Moment &moment) {
    const double now = mechanical_energy(moment);
    if (!*start) *start = now;
    return std::abs(now / **start - 1);
  };
}

namespace {

/* Adds up the turn of a body from one moment to the next. */
class TurnCounter {
public:
  TurnCounter(uint32_t body, const Vector &axis) : body_(body), axis_(axis.normalized()) {}
  double note(const Moment &moment)
  {
    const Eigen::Quaterniond now = eigen_of(moment.bodies[body_].orientation);
    if (last_) {
      const Eigen::Quaterniond turn = now * last_->conjugate();
      sum_ += std::remainder(2 * std::atan2(turn.vec().dot(axis_), turn.w()), 2 * pi);
    }
    last_ = now;
    return sum_;
  }

private:
  uint32_t body_;
  Vector axis_;
  std::optional<Eigen::Quaterniond> last_;
  double sum_ = 0;
};

} // namespace

Figure turns_about(uint32_t body, const Vector &axis)
{
  return [counter = std::make_shared<TurnCounter>(body, axis)](const Moment &moment) { return counter->note(moment); };
}

} // namespace tandem::stability
