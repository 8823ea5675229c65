/* joints.h - joints placed in the world, for the tests of physics, and what their motion is compared with. */
#pragma once

#include <limits>

#include <tandem/metrics.h>

#include "tests/physics/physics.h"

namespace tandem::physics_tests {

inline constexpr JointType all_joint_types[] = {JointType::ball,    JointType::fixed,       JointType::hinge,
                                                JointType::slider,  JointType::cylindrical, JointType::plane,
                                                JointType::parallel};

inline std::string name_of_type(JointType type) { return joint_type_names()[static_cast<size_t>(type)]; }

inline Eigen::Quaterniond eigen_of(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(); }

inline Quat quat_of(const Eigen::Quaterniond &q) { return {float(q.x()), float(q.y()), float(q.z()), float(q.w())}; }

/* The turn of the x axis to a direction. */
inline Eigen::Quaterniond turn_of_x_to(const Vector &direction)
{
  const Vector to = direction.normalized(), axis = Vector::UnitX().cross(to);
  const Vector about = axis.norm() > 1e-9 ? Vector(axis.normalized()) : Vector(Vector::UnitY());
  return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(axis.norm(), to.x()), about));
}

/* A frame of the world as the frame of one side of a joint. */
inline void place_frame(const Scene &scene, uint32_t body, const Vector &at, const Eigen::Quaterniond &axes,
                        Point &position, Quat &orientation)
{
  Vector center = Vector::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (body != no_body) {
    center = vector_of(scene.bodies[body].position);
    turn = eigen_of(scene.bodies[body].orientation);
  }
  position = point_of(turn.conjugate() * (at - center));
  orientation = quat_of(turn.conjugate() * axes);
}

/* A closed joint whose frames are where `at` and the direction of its axis say, in the world. */
inline Joint &connect(Scene &scene, JointType type, uint32_t a, uint32_t b, const Vector &at,
                      const Vector &axis = Vector::UnitX())
{
  Joint joint;
  joint.type = type;
  joint.body_a = a;
  joint.body_b = b;
  const Eigen::Quaterniond axes = turn_of_x_to(axis);
  place_frame(scene, a, at, axes, joint.position_a, joint.orientation_a);
  place_frame(scene, b, at, axes, joint.position_b, joint.orientation_b);
  scene.joints.push_back(joint);
  return scene.joints.back();
}

/* One thread, in the order of the sources. */
inline const Placement on_serial{"serial", {}, false};

/* Boxes that hang one below the other, on joints half-way between. */
inline Scene hanging_boxes(int boxes, float mass, JointType type = JointType::ball)
{
  Scene scene = empty_scene();
  for (int k = 0; k < boxes; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {0, -double(k), 0}).mass = mass;
    connect(scene, type, k == 0 ? no_body : uint32_t(k - 1), uint32_t(k), {0, 0.5 - k, 0});
  }
  return scene;
}

/* A hub, body 0, with so many balls around it, each on a joint. */
inline Scene hub_with_balls(uint32_t balls, const Vec3 &gravity)
{
  Scene scene = empty_scene(gravity);
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0, 0}).mass = 10;
  scene.shapes.push_back(sphere_shape(0.02f));
  for (uint32_t k = 0; k < balls; ++k) {
    const double height = 1 - 2 * (k + 0.5) / balls, angle = 2.399963 * k, radius = std::sqrt(1 - height * height);
    Body body;
    body.shape = 1;
    body.mass = 0.05f;
    body.position = {2 * radius * std::cos(angle), 2 * height, 2 * radius * std::sin(angle)};
    scene.bodies.push_back(body);
    connect(scene, JointType::ball, 0, k + 1, vector_of(body.position));
  }
  return scene;
}

/* Two free boxes that fly and tumble, with a joint between them. */
inline Scene tumbling_pair(Random &random, JointType type)
{
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 2; ++i) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.2f), {1.2 * i, 0, 0.1 * i});
    body.orientation = any_turn(random);
    body.mass = float(1 + i);
    body.linear_velocity = vec3_of(direction(random));
    body.angular_velocity = vec3_of(3 * direction(random));
  }
  connect(scene, type, 0, 1, {0.6, 0.1, 0}, direction(random));
  return scene;
}

inline JointErrorSummary open_joints(World &world)
{
  return summary_of(joint_errors(world.scene(), world.precise_bodies()));
}

/* A pendulum's swing compared with a small one: 1 / M(1, cos(angle / 2)), where M is the arithmetic-geometric mean. */
inline double lengthening_of_period(double angle)
{
  double a = 1, b = std::cos(0.5 * angle);
  while (std::abs(a - b) > 1e-15) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

inline double substep_of(const Settings &settings) { return double(settings.step) / settings.substeps; }

/* What joints of this stiffness do to a motion under a load, an acceleration of their frames: soft_contact of
 * host/scene/parameters.cpp. */
struct Softness {
  double rate, stretch; /* 1/s at which gaps close; m at a load of 1 m/s^2 that does not change */
  double open;          /* m at a load of 1 m/s^2 that turns, of which each substep leaves half a square */
  explicit Softness(const Settings &settings)
  {
    const double h = substep_of(settings), w = 2 * pi * joint_hertz_of(settings);
    rate = w / (2 * settings.joint_damping_ratio + h * w);
    stretch = 1 / (w * w);
    open = stretch + 0.5 * h / rate;
  }
};

/* Joints as stiff as the substep allows, because a joint of a given frequency stays soft however short the substep. */
inline Settings stiff_settings(double step)
{
  Settings settings = settings_with(step);
  settings.joint_hertz = 1e6f;
  return settings;
}

/* Whose rounding does not hide the order of an error. */
inline const Placement in_double{"reference", {}, false};

/* Errors of motions in steps each half as long as the one before: first order halves them, a higher one does more. */
inline bool falls_with_first_order(const std::vector<double> &errors)
{
  for (size_t k = 1; k < errors.size(); ++k)
    if (!(std::abs(errors[k]) < 0.6 * std::abs(errors[k - 1]))) return false;
  return errors.size() > 1;
}

/* The moments at which a number that is noted once a step grows through 0, interpolated. */
class ZeroCrossings {
public:
  void note(double time, double value)
  {
    if (last_value_ < 0 && value >= 0)
      times_.push_back(last_time_ + (time - last_time_) * last_value_ / (last_value_ - value));
    last_time_ = time;
    last_value_ = value;
  }
  const std::vector<double> &times() const { return times_; }
  double interval(size_t first, size_t count) const
  {
    return (times_.at(first + count) - times_.at(first)) / double(count);
  }

private:
  std::vector<double> times_;
  double last_time_ = 0, last_value_ = std::numeric_limits<double>::infinity();
};

} // namespace tandem::physics_tests
