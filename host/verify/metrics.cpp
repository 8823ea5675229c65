/* metrics.cpp - computes the metrics from downloaded states and buffers; see host/include/tandem/metrics.h. */
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <tandem/error.h>
#include <tandem/metrics.h>

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/memory.h"
#include "host/scene/specialise.h"
#include "shared/counts.h"
#include "shared/platform.h"
#include "shared/point_numbers.h"

namespace tandem {
namespace {

using Vector = Eigen::Vector3d;
using Pair = Eigen::Vector2d;

Vector vector_of(const std::array<double, 3> &v) { return {v[0], v[1], v[2]}; }
Vector vector_of(const Vec3 &v) { return {v[0], v[1], v[2]}; }
std::array<double, 3> array_of(const Vector &v) { return {v.x(), v.y(), v.z()}; }

Eigen::Quaterniond quaternion_of(const std::array<double, 4> &q) { return {q[3], q[0], q[1], q[2]}; }

/* Principal moments of a body; 0 if it cannot rotate. */
Vector moments_of(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  Vector moments;
  for (int k = 0; k < 3; ++k) moments[k] = inverse[k] > 0 ? 1.0 / inverse[k] : 0.0;
  return moments;
}

/* The velocity of a body at the end of the step, its displacement within it and its inertia, as the solver left
 * them. */
struct SolverBody {
  Vector linear, angular, moved;
  double inverse_mass;
};

/* What World keeps after a step only if it is told to. */
constexpr Buffer kept_for_residuals[] = {Buffer::constraint_center, Buffer::constraint_offset};

void check_kept(const Memory &memory)
{
  for (const Buffer buffer : kept_for_residuals)
    if (!memory.is_held(buffer))
      throw InputError("step_residuals: the contacts of the last step were not kept; call keep_residuals before it");
}

/* The contact problem of the last step, read from the buffers of the solver. */
class StepContacts {
public:
  explicit StepContacts(World &world) : step_(world.settings().step)
  {
    Memory &memory = world.memory();
    const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    if (memory.bytes(Buffer::constraint_normal_impulse) == 0) return; /* the solver has no impulses */
    count = counts[COUNT_CONSTRAINTS];
    if (count == 0) return;
    check_kept(memory);
    stride_ = counts[CAPACITY_PAIRS];
    a_ = memory.read<uint32_t>(Buffer::constraint_a, count);
    b_ = memory.read<uint32_t>(Buffer::constraint_b, count);
    velocity_ = memory.read_reals(Buffer::solver_velocity, 8 * size_t{counts[COUNT_BODIES]});
    delta_ = memory.read_reals(Buffer::solver_delta_pose, 8 * size_t{counts[COUNT_BODIES]});
    normal_ = plane(memory, Buffer::constraint_normal, 0);
    read_points(memory, counts[CAPACITY_POINTS]);
    center_ = plane(memory, Buffer::constraint_center, 0);
    offset_ = plane(memory, Buffer::constraint_offset, 0);
    normal_impulse_ = plane(memory, Buffer::constraint_normal_impulse, 0);
    friction_impulse_ = memory.bytes(Buffer::constraint_friction_impulse) > 0
                            ? plane(memory, Buffer::constraint_friction_impulse, 0)
                            : std::vector<double>(4 * count); /* a scene without friction: shared/friction_rows.h */
    if (memory.bytes(Buffer::constraint_restitution) == 0) return;
    for (size_t k = 0; k < 2; ++k) restitution_[k] = plane(memory, Buffer::constraint_restitution, k);
  }

  struct Point {
    bool used = false;
    double impulse = 0, mass = 0, started = 0, speed = 0; /* speed: minus the target speed of restitution */
  };
  struct Friction {
    double limit = 0, mass = 0;
    Pair impulse, speed;
    double twist = 0, twist_mass = 0, twist_radius = 0, spin = 0;
  };

  Point point(size_t i, size_t k) const
  {
    Point p;
    p.mass = of_point(i, k, POINT_MASS);
    p.used = p.mass > 0;
    if (!p.used) return p;
    p.impulse = normal_impulse_[4 * i + k];
    p.started = of_point(i, k, POINT_SEPARATION);
    const Vector arm{of_point(i, k, POINT_X), of_point(i, k, POINT_Y), of_point(i, k, POINT_Z)};
    p.speed = normal(i).dot(relative_velocity(i, arm, arm - at(offset_, i)));
    const double target_velocity = restitution_[0].empty() ? -1 : restitution_[0][4 * i + k];
    if (target_velocity >= 0 && restitution_[1][4 * i + k] > 0) p.speed -= target_velocity;
    return p;
  }

  Friction friction(size_t i) const
  {
    Friction f;
    double normal_impulse_sum = 0;
    for (size_t k = 0; k < 4; ++k) normal_impulse_sum += normal_impulse_[4 * i + k];
    f.limit = coefficient(i) * normal_impulse_sum;
    f.mass = center_[4 * i + 3];
    f.impulse = {friction_impulse_[4 * i], friction_impulse_[4 * i + 1]};
    const Vector arm = at(center_, i), slide = relative_velocity(i, arm, arm - at(offset_, i)), n = normal(i);
    f.speed = {first_tangent(n).dot(slide), second_tangent(n).dot(slide)};
    f.twist = friction_impulse_[4 * i + 2];
    f.twist_radius = friction_impulse_[4 * i + 3];
    f.twist_mass = offset_[4 * i + 3];
    f.spin = n.dot(body(b_[i]).angular - body(a_[i]).angular);
    return f;
  }

  double step() const { return step_; }

  size_t count = 0;

private:
  /* Points without a plane are zeros (shared/point_rows.h). */
  void read_points(Memory &memory, size_t of_pair)
  {
    for (size_t plane = 0; plane < points_.size(); ++plane)
      points_[plane] = plane < of_pair * POINT_NUMBERS
                           ? memory.read_reals(Buffer::constraint_points, count, plane * stride_)
                           : std::vector<double>(count);
  }
  double of_point(size_t i, size_t k, size_t number) const { return points_[k * POINT_NUMBERS + number][i]; }
  std::vector<double> plane(Memory &memory, Buffer buffer, size_t k) const
  {
    return memory.read_reals(buffer, 4 * count, 4 * k * stride_);
  }
  static Vector at(const std::vector<double> &rows, size_t i)
  {
    return {rows[4 * i], rows[4 * i + 1], rows[4 * i + 2]};
  }
  Vector normal(size_t i) const { return at(normal_, i); }
  /* packed_friction of shared/setup/contact.h. */
  bool arms_stay(size_t i) const { return normal_[4 * i + 3] < 0; }
  double coefficient(size_t i) const { return arms_stay(i) ? -1 - normal_[4 * i + 3] : normal_[4 * i + 3]; }

  SolverBody body(size_t i) const
  {
    const double *v = &velocity_[8 * i], *d = &delta_[8 * i];
    return {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {d[0], d[1], d[2]}, v[3]};
  }

  /* The contact arms move with the bodies, as in shift_of_arms of shared/setup/contact.h. */
  Vector relative_velocity(size_t i, Vector arm_a, Vector arm_b) const
  {
    const SolverBody a = body(a_[i]), b = body(b_[i]);
    const Vector slid = arms_stay(i) ? Vector(0, 0, 0) : Vector(b.moved - a.moved);
    const double share = a.inverse_mass == 0 ? 1 : b.inverse_mass == 0 ? 0 : 0.5;
    arm_a += share * slid;
    arm_b += (share - 1) * slid;
    return b.linear + b.angular.cross(arm_b) - a.linear - a.angular.cross(arm_a);
  }

  /* The basis of the friction impulses: tangents_of of shared/math.h. */
  static double sign_of(const Vector &n) { return n.z() >= 0 ? 1 : -1; }
  static Vector first_tangent(const Vector &n)
  {
    const double sign = sign_of(n), a = -1 / (sign + n.z());
    return {1 + sign * n.x() * n.x() * a, sign * n.x() * n.y() * a, -sign * n.x()};
  }
  static Vector second_tangent(const Vector &n)
  {
    const double sign = sign_of(n), a = -1 / (sign + n.z());
    return {n.x() * n.y() * a, sign + n.y() * n.y() * a, -n.y()};
  }

  double step_;
  size_t stride_ = 0;
  std::vector<uint32_t> a_, b_;
  std::vector<double> velocity_, delta_, normal_, normal_impulse_, friction_impulse_;
  std::vector<double> center_, offset_;
  std::array<std::vector<double>, 4 * POINT_NUMBERS> points_;
  std::array<std::vector<double>, 2> restitution_;
};

/* The speed error of a point at the end of the step. A gap may close within the step, so any speed from closing it to
 * rest is correct. */
double owed_speed(const StepContacts::Point &p, double step)
{
  if (p.speed > 0) return p.speed;
  return std::min(p.speed + std::max(p.started, 0.0) / step, 0.0);
}

/* f - the projection of f - r u on a disc, which is 0 iff f lies in the disc and opposes u where it slips (maximum
 * dissipation). */
template <class V> V disc_natural_map(const V &impulse, const V &mass_speed, double limit)
{
  V projected = impulse - mass_speed;
  const double length = projected.norm();
  if (length > limit) projected *= length > 0 ? limit / length : 0;
  return impulse - projected;
}

/* |x + y - sqrt(x^2 + y^2)| with the products of Jordan on Lorentz's cone, x = (limit, impulse), y = (|mass_speed|,
 * mass_speed). */
template <class V> double disc_fischer_burmeister(const V &impulse, const V &mass_speed, double limit)
{
  const double y0 = mass_speed.norm();
  const double z0 = limit * limit + impulse.squaredNorm() + y0 * y0 + mass_speed.squaredNorm();
  const V z = 2 * (limit * impulse + y0 * mass_speed);
  const double length = z.norm(), high = std::sqrt(z0 + length), low = std::sqrt(std::max(z0 - length, 0.0));
  const V root = length > 0 ? V(z * (0.5 * (high - low) / length)) : V(V::Zero());
  return std::hypot(limit + y0 - 0.5 * (high + low), (impulse + mass_speed - root).norm());
}

struct Sums {
  double natural_map = 0, fischer_burmeister = 0, impulses = 0, violation = 0,
         limit = 0; /* squares, but for the last two */
};

void add_points(const StepContacts &problem, size_t i, Sums &sums)
{
  for (size_t k = 0; k < 4; ++k) {
    const StepContacts::Point p = problem.point(i, k);
    const bool still_ahead = p.started > 0 && p.impulse == 0;
    if (!p.used || still_ahead) continue;
    const double owed = p.mass * owed_speed(p, problem.step());
    sums.natural_map += std::pow(natural_map_of(p.impulse, owed), 2);
    sums.fischer_burmeister += std::pow(fischer_burmeister_of(p.impulse, owed), 2);
    sums.impulses += p.impulse * p.impulse;
  }
}

void add_friction(const StepContacts &problem, size_t i, Sums &sums)
{
  using Single = Eigen::Matrix<double, 1, 1>;
  const StepContacts::Friction f = problem.friction(i);
  sums.limit = std::max(sums.limit, f.limit);
  sums.violation = std::max(sums.violation, f.impulse.norm() - f.limit);
  const Pair mass_speed = f.mass * f.speed;
  sums.natural_map += disc_natural_map(f.impulse, mass_speed, f.limit).squaredNorm();
  sums.fischer_burmeister += std::pow(disc_fischer_burmeister(f.impulse, mass_speed, f.limit), 2);
  sums.impulses += f.impulse.squaredNorm();
  if (f.twist_radius <= 0) return;
  const Single twist(f.twist / f.twist_radius), spin(f.twist_mass * f.spin / f.twist_radius);
  sums.natural_map += disc_natural_map(twist, spin, f.limit).squaredNorm();
  sums.fischer_burmeister += std::pow(disc_fischer_burmeister(twist, spin, f.limit), 2);
  sums.impulses += twist.squaredNorm();
}

} // namespace

double angle_between(const std::array<double, 4> &one, const std::array<double, 4> &other)
{
  const Eigen::Quaterniond turn = quaternion_of(one).conjugate() * quaternion_of(other);
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

void TrajectoryError::add(const Scene &scene, const PreciseBodies &states, const PreciseBodies &truth)
{
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].type != BodyType::dynamic) continue;
    const double distance = (vector_of(states[i].position) - vector_of(truth[i].position)).norm();
    const double angle = angle_between(states[i].orientation, truth[i].orientation);
    position_squares_ += distance * distance;
    angle_squares_ += angle * angle;
    position_max_ = std::max(position_max_, distance);
    angle_max_ = std::max(angle_max_, angle);
    ++count_;
  }
}

double TrajectoryError::position_rms() const
{
  return count_ ? std::sqrt(position_squares_ / static_cast<double>(count_)) : 0;
}
double TrajectoryError::angle_rms() const
{
  return count_ ? std::sqrt(angle_squares_ / static_cast<double>(count_)) : 0;
}

Conserved conserved_quantities(const Scene &scene, const PreciseBodies &states)
{
  Conserved sum;
  Vector momentum = Vector::Zero(), angular = Vector::Zero();
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body &body = scene.bodies[i];
    if (body.type != BodyType::dynamic) continue;
    const double mass = body.mass;
    const Vector x = vector_of(states[i].position), v = vector_of(states[i].linear_velocity),
                 w = vector_of(states[i].angular_velocity);
    const Eigen::Matrix3d axes = quaternion_of(states[i].orientation).normalized().toRotationMatrix();
    const Vector spin = axes * moments_of(scene, body).cwiseProduct(axes.transpose() * w);
    momentum += mass * v;
    angular += mass * x.cross(v) + spin;
    sum.kinetic += 0.5 * mass * v.squaredNorm() + 0.5 * w.dot(spin);
    sum.potential -= mass * double{body.gravity_factor} * vector_of(scene.gravity).dot(x);
  }
  sum.momentum = array_of(momentum);
  sum.angular_momentum = array_of(angular);
  return sum;
}

double mean_height(const Scene &scene, const PreciseBodies &states)
{
  const Vector gravity = vector_of(scene.gravity);
  const Vector up = gravity.norm() > 0 ? Vector(-gravity.normalized()) : Vector(Vector::UnitY());
  double sum = 0, count = 0;
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].type == BodyType::dynamic) sum += up.dot(vector_of(states[i].position)), ++count;
  return count > 0 ? sum / count : 0;
}

double natural_map_of(double impulse, double mass_speed) { return impulse - std::max(impulse - mass_speed, 0.0); }

double fischer_burmeister_of(double impulse, double mass_speed)
{
  return impulse + mass_speed - std::hypot(impulse, mass_speed);
}

void keep_residuals(World &world)
{
  for (const Buffer buffer : kept_for_residuals) world.keep_after_steps(buffer);
}

StepResiduals step_residuals(World &world)
{
  const StepContacts problem(world);
  Sums sums;
  for (size_t i = 0; i < problem.count; ++i) {
    add_points(problem, i, sums);
    add_friction(problem, i, sums);
  }
  StepResiduals residuals;
  if (sums.impulses > 0) {
    residuals.natural_map = std::sqrt(sums.natural_map / sums.impulses);
    residuals.fischer_burmeister = std::sqrt(sums.fischer_burmeister / sums.impulses);
  }
  if (sums.limit > 0) residuals.cone_violation = std::max(sums.violation, 0.0) / sums.limit;
  return residuals;
}

} // namespace tandem
