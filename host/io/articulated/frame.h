/* frame.h - a pose: where a frame stands in another one. This is not a public header. */
#pragma once

#include "host/base/trigonometry.h"
#include "host/geometry/rotation.h"

namespace tandem {

struct RigidFrame {
  Vector position{0, 0, 0};
  Rotation rotation{0, 0, 0, 1};
};

inline RigidFrame operator*(const RigidFrame &outer, const RigidFrame &inner)
{
  return {outer.position + turn(outer.rotation, inner.position), unit(product_of(outer.rotation, inner.rotation))};
}

inline Vector operator*(const RigidFrame &frame, const Vector &point)
{
  return frame.position + turn(frame.rotation, point);
}

inline RigidFrame inverse(const RigidFrame &frame)
{
  const Rotation back = inverse(frame.rotation);
  return {-turn(back, frame.position), back};
}

/* The axis is of unit length, the angle at most 10^6 rad in size. */
inline Rotation rotation_about(const Vector &axis, double angle)
{
  const SineCosine half = sine_cosine(angle / 2);
  return {half.sine * axis.x, half.sine * axis.y, half.sine * axis.z, half.cosine};
}

inline Quat quat_of(const Rotation &rotation)
{
  Quat result;
  for (size_t i = 0; i < 4; ++i) result[i] = round_to_float(rotation[i]);
  return result;
}

/* The shapes of URDF and MJCF stand along Z, those of a scene along Y: the frame of the second kind in the first. */
inline RigidFrame y_along_z()
{
  const double half = std::sqrt(0.5);
  return {{0, 0, 0}, {half, 0, 0, half}};
}

/* The frame whose x and y are these; y is turned to a right angle. Neither is 0, nor are they parallel. */
inline Rotation rotation_of_axes(const Vector &x, const Vector &y)
{
  const Vector along = x.normalized(), across = (y - along.dot(y) * along).normalized();
  return rotation_of(Matrix::of_columns(along, across, along.cross(across)));
}

/* A vector at a right angle to another one, which is of unit length. */
inline Vector any_across(const Vector &axis)
{
  const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
  const Vector other = x <= y && x <= z ? Vector(1, 0, 0) : y <= z ? Vector(0, 1, 0) : Vector(0, 0, 1);
  return other.cross(axis).normalized();
}

} // namespace tandem
