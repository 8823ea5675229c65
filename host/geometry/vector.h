/* vector.h - vectors and matrices in double, with the order of every rounding fixed here.
 *
 * A linear algebra library chooses the order of a sum, and whether products are fused with it, by the processor and the
 * compiler options. Hulls and masses must be the same numbers everywhere (docs/exactness.md).
 */
#pragma once

#include <cmath>

#include "host/geometry/geometry.h"

namespace tandem {

struct Vector {
  double x = 0, y = 0, z = 0;

  Vector() = default;
  Vector(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}

  double dot(const Vector &o) const { return x * o.x + y * o.y + z * o.z; }
  Vector cross(const Vector &o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  double squared_norm() const { return dot(*this); }
  double norm() const { return std::sqrt(squared_norm()); }
  Vector normalized() const; /* the zero vector stays */
};

inline Vector operator+(const Vector &a, const Vector &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector &a, const Vector &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator-(const Vector &a) { return {-a.x, -a.y, -a.z}; }
inline Vector operator*(double s, const Vector &a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vector operator*(const Vector &a, double s) { return s * a; }
inline Vector operator/(const Vector &a, double s) { return {a.x / s, a.y / s, a.z / s}; }
inline Vector &operator+=(Vector &a, const Vector &b) { return a = a + b; }

inline Vector Vector::normalized() const
{
  const double length = norm();
  return length > 0 ? *this / length : *this;
}

inline Vector vector_of(const Vec3 &v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }
inline Vector vector_of(const Double3 &v) { return {v[0], v[1], v[2]}; }
inline Double3 array_of(const Vector &v) { return {v.x, v.y, v.z}; }

/* at[row][column]. */
struct Matrix {
  double at[3][3] = {};

  static Matrix diagonal(double x, double y, double z) { return {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }
  static Matrix of_columns(const Vector &a, const Vector &b, const Vector &c)
  {
    return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
  }
  static Matrix outer(const Vector &a, const Vector &b) { return of_columns(a * b.x, a * b.y, a * b.z); }

  Vector row(int i) const { return {at[i][0], at[i][1], at[i][2]}; }
  Vector column(int i) const { return {at[0][i], at[1][i], at[2][i]}; }
  Matrix transposed() const { return of_columns(row(0), row(1), row(2)); }
  double trace() const { return at[0][0] + at[1][1] + at[2][2]; }
  double determinant() const { return column(0).dot(column(1).cross(column(2))); }
};

inline Matrix operator+(const Matrix &a, const Matrix &b)
{
  return Matrix::of_columns(a.column(0) + b.column(0), a.column(1) + b.column(1), a.column(2) + b.column(2));
}
inline Matrix operator*(double s, const Matrix &a)
{
  return Matrix::of_columns(s * a.column(0), s * a.column(1), s * a.column(2));
}
inline Matrix operator-(const Matrix &a, const Matrix &b) { return a + -1 * b; }
inline Vector operator*(const Matrix &a, const Vector &v)
{
  return {a.row(0).dot(v), a.row(1).dot(v), a.row(2).dot(v)};
}
inline Matrix operator*(const Matrix &a, const Matrix &b)
{
  return Matrix::of_columns(a * b.column(0), a * b.column(1), a * b.column(2));
}

} // namespace tandem
