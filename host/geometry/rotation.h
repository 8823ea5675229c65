/* rotation.h - rotations as quaternions x y z w in double, with the order of every rounding fixed here, as in
 * host/geometry/vector.h. */
#pragma once

#include "host/geometry/vector.h"

namespace tandem {

inline Rotation unit(const Rotation &q)
{
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

inline Rotation inverse(const Rotation &q) { return {-q[0], -q[1], -q[2], q[3]}; }

/* The rotation that applies b first, then a. */
inline Rotation product_of(const Rotation &a, const Rotation &b)
{
  const Vector u(a[0], a[1], a[2]), v(b[0], b[1], b[2]), w = u.cross(v) + (a[3] * v + b[3] * u);
  return {w.x, w.y, w.z, a[3] * b[3] - u.dot(v)};
}

inline Vector turn(const Rotation &q, const Vector &v)
{
  const Vector axis(q[0], q[1], q[2]), across = 2 * axis.cross(v);
  return v + (q[3] * across + axis.cross(across));
}

inline Matrix rotation_matrix(const Rotation &q)
{
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/* The quaternion of a rotation matrix, with w >= 0. The largest component is computed first, so that no division is by
 * a small number. */
TANDEM_API Rotation rotation_of(const Matrix &m);

} // namespace tandem
