/* math.h - vectors, quaternions, matrices and the elementary functions on them.
 *
 * The functions use only + - * / and sqrt, comparisons and choose(). Each of these is correctly rounded on every
 * backend that passed the self-test, so each function gives equal bits everywhere and at every width. The built-in dot,
 * cross, length, min, max, sin and kin are banned (docs/exactness.md).
 */
#ifndef TANDEM_SHARED_MATH_H
#define TANDEM_SHARED_MATH_H

#include "shared/real.h"

typedef struct {
  real x, y, z;
} vec3;
/* A rotation w + xi + yj + zk of unit length. */
typedef struct {
  real x, y, z, w;
} quat;
/* The rows of a rotation: row k holds the k-th coordinate of the three body axes. */
typedef struct {
  vec3 x, y, z;
} mat3;
/* Symmetric 3x3 matrix. */
typedef struct {
  real xx, yy, zz, xy, xz, yz;
} symmetric3;

SHARED real minimum(real a, real b) { return choose(a < b, a, b); }
SHARED real maximum(real a, real b) { return choose(a > b, a, b); }
SHARED real clamped(real x, real low, real high) { return maximum(low, minimum(x, high)); }
SHARED real magnitude(real x) { return choose(x < R(0.0), -x, x); }

SHARED vec3 make_vec3(real x, real y, real z)
{
  vec3 v = {x, y, z};
  return v;
}
SHARED real least_of(vec3 v) { return minimum(v.x, minimum(v.y, v.z)); }
/* The component that is neither the least nor the largest of the three. */
SHARED real middle_of(vec3 v) { return maximum(minimum(v.x, v.y), minimum(maximum(v.x, v.y), v.z)); }
SHARED vec4 make_vec4(real x, real y, real z, real w)
{
  vec4 v = {x, y, z, w};
  return v;
}
SHARED vec4 extend(vec3 v, real w) { return make_vec4(v.x, v.y, v.z, w); }
SHARED vec4 add4(vec4 a, vec4 b) { return make_vec4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }
SHARED vec4 scale4(vec4 v, real s) { return make_vec4(v.x * s, v.y * s, v.z * s, v.w * s); }
SHARED vec4 add_scaled4(vec4 sum, vec4 v, real factor)
{
  return make_vec4(sum.x + factor * v.x, sum.y + factor * v.y, sum.z + factor * v.z, sum.w + factor * v.w);
}
SHARED vec4 change_between(vec4 before, vec4 now)
{
  return make_vec4(now.x - before.x, now.y - before.y, now.z - before.z, now.w - before.w);
}
SHARED vec3 xyz(vec4 v) { return make_vec3(v.x, v.y, v.z); }

SHARED vec3 add(vec3 a, vec3 b) { return make_vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
SHARED vec3 subtract(vec3 a, vec3 b) { return make_vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
SHARED vec3 scale(vec3 v, real s) { return make_vec3(v.x * s, v.y * s, v.z * s); }
SHARED vec3 negate(vec3 v) { return make_vec3(-v.x, -v.y, -v.z); }
/* a + s b */
SHARED vec3 add_scaled(vec3 a, vec3 b, real s) { return make_vec3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s); }
SHARED vec3 multiply(vec3 a, vec3 b) { return make_vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
SHARED vec3 absolute(vec3 v) { return make_vec3(magnitude(v.x), magnitude(v.y), magnitude(v.z)); }
SHARED vec3 choose3(mask m, vec3 a, vec3 b)
{
  return make_vec3(choose(m, a.x, b.x), choose(m, a.y, b.y), choose(m, a.z, b.z));
}

SHARED vec4 choose4(mask m, vec4 a, vec4 b)
{
  return make_vec4(choose(m, a.x, b.x), choose(m, a.y, b.y), choose(m, a.z, b.z), choose(m, a.w, b.w));
}
/* Component k, from 0. */
SHARED real component(vec4 v, uint_lanes k)
{
  return choose(k < 2u, choose(k == 0u, v.x, v.y), choose(k == 2u, v.z, v.w));
}

SHARED real dot3(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SHARED vec3 cross3(vec3 a, vec3 b)
{
  return make_vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
SHARED real length_squared(vec3 v) { return dot3(v, v); }
SHARED real length_of(vec3 v) { return square_root(dot3(v, v)); }

SHARED vec3 symmetric_times(symmetric3 m, vec3 v)
{
  return make_vec3(m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                   m.xz * v.x + m.yz * v.y + m.zz * v.z);
}

/* Two unit vectors that complete the unit vector n to a right-handed basis (Duff et al., "Building an Orthonormal
 * Basis, Revisited", JCGT 6(1), 2017). */
typedef struct {
  vec3 first, second;
} tangents;
SHARED tangents tangents_of(vec3 n)
{
  real sign = choose(n.z >= R(0.0), (real)R(1.0), (real)R(-1.0));
  real a = R(-1.0) / (sign + n.z);
  real b = n.x * n.y * a;
  tangents t = {{R(1.0) + sign * n.x * n.x * a, sign * b, -(sign * n.x)}, {b, sign + n.y * n.y * a, -n.y}};
  return t;
}

SHARED quat make_quat(real x, real y, real z, real w)
{
  quat q = {x, y, z, w};
  return q;
}
SHARED quat quat_from(vec4 v) { return make_quat(v.x, v.y, v.z, v.w); }
SHARED vec4 quat_to_vec4(quat q) { return make_vec4(q.x, q.y, q.z, q.w); }
SHARED quat quat_multiply(quat a, quat b)
{
  return make_quat(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                   a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
}
SHARED quat quat_normalized(quat q)
{
  real s = R(1.0) / square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return make_quat(q.x * s, q.y * s, q.z * s, q.w * s);
}
SHARED mat3 rotation_of(quat q)
{
  real xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  real xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  real wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  mat3 m = {{R(1.0) - R(2.0) * (yy + zz), R(2.0) * (xy - wz), R(2.0) * (xz + wy)},
            {R(2.0) * (xy + wz), R(1.0) - R(2.0) * (xx + zz), R(2.0) * (yz - wx)},
            {R(2.0) * (xz - wy), R(2.0) * (yz + wx), R(1.0) - R(2.0) * (xx + yy)}};
  return m;
}
SHARED vec3 rotate(mat3 m, vec3 v) { return make_vec3(dot3(m.x, v), dot3(m.y, v), dot3(m.z, v)); }
/* The transpose of m times v: transforms from world to body axes. */
SHARED vec3 rotate_back(mat3 m, vec3 v)
{
  return make_vec3(m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
                   m.x.z * v.x + m.y.z * v.y + m.z.z * v.z);
}
SHARED vec3 axis_x(mat3 m) { return make_vec3(m.x.x, m.y.x, m.z.x); }
SHARED vec3 axis_y(mat3 m) { return make_vec3(m.x.y, m.y.y, m.z.y); }
SHARED vec3 axis_z(mat3 m) { return make_vec3(m.x.z, m.y.z, m.z.z); }

/* Rotates each axis of a rotation. */
SHARED mat3 turned_axes(mat3 turn, mat3 axes)
{
  vec3 x = rotate(turn, axis_x(axes)), y = rotate(turn, axis_y(axes)), z = rotate(turn, axis_z(axes));
  mat3 m = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
  return m;
}

/* The rotation from the axes of `from` into those of `to`. */
SHARED mat3 relative_rotation(mat3 to, mat3 from)
{
  vec3 x = rotate_back(to, axis_x(from)), y = rotate_back(to, axis_y(from)), z = rotate_back(to, axis_z(from));
  mat3 m = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
  return m;
}

/* R diag(d) R^T, computed as least I + R diag(d - least) R^T. The rows of R are orthogonal only to rounding; the common
 * part of d, multiplied by that rounding, would otherwise appear in every off-diagonal element. */
SHARED symmetric3 rotate_diagonal(mat3 m, vec3 d)
{
  real least = minimum(d.x, minimum(d.y, d.z));
  vec3 rest = make_vec3(d.x - least, d.y - least, d.z - least);
  vec3 x = multiply(m.x, rest), y = multiply(m.y, rest), z = multiply(m.z, rest);
  symmetric3 s = {least + dot3(x, m.x), least + dot3(y, m.y), least + dot3(z, m.z),
                  dot3(x, m.y),         dot3(x, m.z),         dot3(y, m.z)};
  return s;
}

/* The number of the lowest bit of x, which has one. */
SHARED uint lowest_bit(uint x) { return 31u - (uint)LEADING_ZEROS(x & (0u - x)); }

#endif
