/* moved_mass.cpp - effective masses by projection; see moved_mass.h.
 *
 * With the rows J of a joint, M the masses of its bodies and <a, b> = a M^-1 b^T, an impulse along row d changes the
 * speed along it by <d, d>. If the joint holds other rows, these answer with impulses of their own, which leaves of d
 * what is at right angles to them: the inverse of the mass is <d', d'>. (Featherstone, "Rigid Body Dynamics
 * Algorithms", 2008, chapter 8.) */
#include "host/io/gltf/moved_mass.h"

#include <vector>

#include "host/geometry/rotation.h"

namespace tandem {
namespace {

/* The part of a row that belongs to one body, and the body's inverse mass and moments; both in the body's axes. */
struct Side {
  Rotation axes{0, 0, 0, 1};
  Vector center{0, 0, 0}, inverse_moments{0, 0, 0};
  double inverse_mass = 0;
};

double inverse_or_0(double x) { return x > 0 ? 1 / x : 0; }

Side side_of(const Scene &scene, uint32_t number)
{
  Side side;
  if (number == no_body || scene.bodies[number].type != BodyType::dynamic) return side;
  const Body &body = scene.bodies[number];
  side.axes = unit(Rotation{body.orientation[0], body.orientation[1], body.orientation[2], body.orientation[3]});
  side.center = {body.position[0], body.position[1], body.position[2]};
  side.inverse_mass = inverse_or_0(double{body.mass});
  if (body.infinite_inertia) return side;
  const bool given = body.inertia != Vec3{0, 0, 0};
  const Vec3 moments = given ? body.inertia : inertia_of(scene.shapes[body.shape], body.mass);
  side.inverse_moments = {inverse_or_0(double{moments[0]}), inverse_or_0(double{moments[1]}),
                          inverse_or_0(double{moments[2]})};
  return side;
}

struct Row {
  Vector direction{0, 0, 0}, turn_a{0, 0, 0}, turn_b{0, 0, 0}; /* turns: in the axes of their body */
};

Vector scaled_by(const Vector &a, const Vector &b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/* The rows of a joint whose bodies are where the scene has them. */
class Rows {
public:
  Rows(const Scene &scene, const Joint &joint) : a_(side_of(scene, joint.body_a)), b_(side_of(scene, joint.body_b))
  {
    const Quat &q = joint.orientation_a;
    axes_ = product_of(rotation_of_side(scene, joint.body_a), Rotation{q[0], q[1], q[2], q[3]});
    at_ = place_of(scene, joint.body_b, joint.position_b);
  }

  Row row(size_t axis) const
  {
    const Vector along = turn(axes_, Vector(axis % 3 == 0, axis % 3 == 1, axis % 3 == 2));
    const bool linear = axis < 3;
    const auto of = [&](const Side &side) {
      return turn(inverse(side.axes), linear ? (at_ - side.center).cross(along) : along);
    };
    return {linear ? along : Vector(0, 0, 0), of(a_), of(b_)};
  }
  double product(const Row &p, const Row &q) const
  {
    return (a_.inverse_mass + b_.inverse_mass) * p.direction.dot(q.direction) +
           p.turn_a.dot(scaled_by(a_.inverse_moments, q.turn_a)) +
           p.turn_b.dot(scaled_by(b_.inverse_moments, q.turn_b));
  }
  /* What is left of a row beside another. */
  Row without(const Row &row, const Row &other) const
  {
    const double share = product(row, other) / product(other, other);
    return {row.direction - share * other.direction, row.turn_a - share * other.turn_a,
            row.turn_b - share * other.turn_b};
  }

private:
  static Rotation rotation_of_side(const Scene &scene, uint32_t number)
  {
    if (number == no_body) return {0, 0, 0, 1};
    const Quat &q = scene.bodies[number].orientation;
    return unit(Rotation{q[0], q[1], q[2], q[3]});
  }
  static Vector place_of(const Scene &scene, uint32_t number, const Point &position)
  {
    const Vector at(position[0], position[1], position[2]);
    if (number == no_body) return at;
    const Point &center = scene.bodies[number].position;
    return Vector(center[0], center[1], center[2]) + turn(rotation_of_side(scene, number), at);
  }

  Side a_, b_;
  Rotation axes_{};
  Vector at_{0, 0, 0};
};

constexpr double next_to_nothing = 1e-9; /* of a row beside what it was before */

/* The row without what the base answers for; nothing if that is all of it. */
std::optional<Row> remainder(const Rows &rows, const Row &whole, const std::vector<Row> &base)
{
  Row rest = whole;
  for (const Row &other : base) rest = rows.without(rest, other);
  if (!(rows.product(rest, rest) > next_to_nothing * rows.product(whole, whole))) return {};
  return rest;
}

} // namespace

std::optional<double> moved_mass(const Scene &scene, const Joint &drives, const HoldingJoint &holds, size_t axis)
{
  const Rows held_rows(scene, holds.joint), rows(scene, drives);
  const Axes &d = holds.directions, &r = holds.rotations;
  const bool held[] = {d.x, d.y, d.z, r.x, r.y, r.z};
  std::vector<Row> base;
  for (size_t k = 0; k < 6; ++k)
    if (held[k])
      if (const auto rest = remainder(rows, held_rows.row(k), base)) base.push_back(*rest);
  const auto rest = remainder(rows, rows.row(axis), base);
  if (!rest) return {};
  return 1 / rows.product(*rest, *rest);
}

} // namespace tandem
