/* physics.h - small scenes for the tests of physics, and their conserved quantities.
 *
 * A test builds a Scene by hand, runs it through World as a user would, and computes its reference in
 * double precision from what World::bodies() reports.
 */
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/scene/specialise.h"

namespace tandem::physics_tests {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double radians = pi / 180;
inline constexpr double gravity = 10; /* m/s^2, that of Scene */

inline Vector vector_of(const Vec3 &v) { return {v[0], v[1], v[2]}; }
inline Vector vector_of(const Point &p) { return {p[0], p[1], p[2]}; }
inline Point point_of(const Vector &v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 vec3_of(const Vector &v) { return {float(v.x()), float(v.y()), float(v.z())}; }

inline Matrix axes_of(const Quat &q)
{
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

inline Quat turn_about(const Vector &axis, double angle)
{
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis.normalized()));
  return {float(q.x()), float(q.y()), float(q.z()), float(q.w())};
}

/* The turn of the y axis to a unit vector. Eigen's FromTwoVectors decomposes a matrix for it, which takes seconds to
 * compile. */
inline Quat turn_of_y_to(const Vector &unit)
{
  const Vector axis = Vector::UnitY().cross(unit);
  return turn_about(axis.norm() > 0 ? axis : Vector(Vector::UnitX()), std::atan2(axis.norm(), unit.y()));
}

/* A random unit vector, uniform over the sphere. */
inline Vector direction(Random &random)
{
  for (;;) {
    const Vector v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}
inline Quat any_turn(Random &random) { return turn_about(direction(random), random.uniform(0, 2 * pi)); }

/* A random number between low and high, whose logarithm is uniform. */
inline double logarithmic(Random &random, double low, double high)
{
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

inline Scene empty_scene(const Vec3 &gravity = {0, -10, 0})
{
  Scene scene;
  scene.name = "test";
  scene.gravity = gravity;
  return scene;
}

/* A body with a shape of its own. The caller sets other members by the reference, before it adds the next body. */
inline Body &add_body(Scene &scene, BodyType motion, const Shape &shape, const Point &position)
{
  scene.shapes.push_back(shape);
  Body body;
  body.type = motion;
  body.shape = uint32_t(scene.shapes.size() - 1);
  body.position = position;
  scene.bodies.push_back(body);
  return scene.bodies.back();
}

/* The half-space of all points with y <= 0. */
inline Body &add_ground(Scene &scene) { return add_body(scene, BodyType::fixed, half_space_shape(), {0, 0, 0}); }

inline uint32_t add_material(Scene &scene, float friction, float restitution = 0)
{
  Material material;
  material.static_friction = material.dynamic_friction = friction;
  material.restitution = restitution;
  scene.materials.push_back(material);
  return uint32_t(scene.materials.size() - 1);
}

inline void run(World &world, int steps)
{
  for (int i = 0; i < steps; ++i) world.step();
}

inline Settings settings_with(double step, uint32_t substeps = 4)
{
  Settings settings;
  settings.step = float(step);
  settings.substeps = substeps;
  return settings;
}

/* The principal moments of inertia; 0 where infinite. */
inline Vector moments_of(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  Vector moments;
  for (int k = 0; k < 3; ++k) moments[k] = inverse[k] > 0 ? 1.0 / inverse[k] : 0.0;
  return moments;
}

inline Vector spin_momentum(const Scene &scene, const Body &body, const BodyState &state)
{
  const Matrix axes = axes_of(state.orientation);
  return axes * (moments_of(scene, body).asDiagonal() * (axes.transpose() * vector_of(state.angular_velocity)));
}

/* Sums over the dynamic bodies; `scale` sums the lengths, the measure for relative errors. */
struct Momentum {
  Vector linear = Vector::Zero(), angular = Vector::Zero();
  double linear_scale = 0, angular_scale = 0;
};

/* m/s */
inline double fastest(World &world)
{
  double speed = 0;
  for (const BodyState &state : world.bodies()) speed = std::max(speed, vector_of(state.linear_velocity).norm());
  return speed;
}

inline Momentum momentum_of(World &world)
{
  Momentum sum;
  const std::vector<BodyState> states = world.bodies();
  for (size_t i = 0; i < states.size(); ++i) {
    const Body &body = world.scene().bodies[i];
    if (body.type != BodyType::dynamic) continue;
    const Vector linear = double(body.mass) * vector_of(states[i].linear_velocity);
    const Vector orbital = vector_of(states[i].position).cross(linear);
    const Vector spin = spin_momentum(world.scene(), body, states[i]);
    sum.linear += linear;
    sum.angular += orbital + spin;
    sum.linear_scale += linear.norm();
    sum.angular_scale += orbital.norm() + spin.norm();
  }
  return sum;
}

inline bool all_finite(const std::vector<BodyState> &states)
{
  const auto finite = [](const auto &values) {
    return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
  };
  return std::all_of(states.begin(), states.end(), [&](const BodyState &s) {
    return finite(s.position) && finite(s.orientation) && finite(s.linear_velocity) && finite(s.angular_velocity);
  });
}

} // namespace tandem::physics_tests
