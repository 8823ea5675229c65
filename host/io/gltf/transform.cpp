/* transform.cpp - composes and decomposes node transforms; see transform.h. */
#include "host/io/gltf/transform.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tandem {
namespace {

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double length(const double *v) { return std::sqrt(dot(v, v)); }

double determinant(const Transform &t)
{
  const double *a = t.column[0], *b = t.column[1], *c = t.column[2];
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

void rotation_columns(const std::vector<double> &quaternion, Transform &t)
{
  double x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
  double s = 2 / (x * x + y * y + z * z + w * w);
  double columns[3][3] = {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
                          {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
                          {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)}};
  std::copy(&columns[0][0], &columns[0][0] + 9, &t.column[0][0]);
}

/* The quaternion of a rotation matrix; the largest component is computed first, so that no division is by a small
 * number. */
std::array<double, 4> quaternion_of(const double m[3][3])
{
  double trace = m[0][0] + m[1][1] + m[2][2], q[4];
  if (trace > 0) {
    double s = 2 * std::sqrt(1 + trace);
    q[0] = (m[1][2] - m[2][1]) / s, q[1] = (m[2][0] - m[0][2]) / s, q[2] = (m[0][1] - m[1][0]) / s, q[3] = s / 4;
  } else {
    int i = m[1][1] > m[0][0] ? 1 : 0;
    if (m[2][2] > m[i][i]) i = 2;
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double s = 2 * std::sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    q[i] = s / 4, q[j] = (m[i][j] + m[j][i]) / s, q[k] = (m[i][k] + m[k][i]) / s, q[3] = (m[j][k] - m[k][j]) / s;
  }
  double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / size, q[1] / size, q[2] / size, q[3] / size};
}

} // namespace

Transform operator*(const Transform &a, const Transform &b)
{
  Transform product;
  for (int row = 0; row < 3; ++row) {
    product.translation[row] = a.translation[row];
    for (int k = 0; k < 3; ++k) product.translation[row] += a.column[k][row] * b.translation[k];
    for (int j = 0; j < 3; ++j) {
      product.column[j][row] = 0;
      for (int k = 0; k < 3; ++k) product.column[j][row] += a.column[k][row] * b.column[j][k];
    }
  }
  return product;
}

Point transformed(const Transform &t, const Point &p)
{
  Point result;
  for (size_t row = 0; row < 3; ++row)
    result[row] = t.translation[row] + t.column[0][row] * p[0] + t.column[1][row] * p[1] + t.column[2][row] * p[2];
  return result;
}

bool is_mirrored(const Transform &t) { return determinant(t) < 0; }

Transform local_transform(const GltfDocument &document, int index)
{
  const GltfNode &node = document.node(index);
  Transform local;
  if (!node.matrix.empty()) {
    for (int j = 0; j < 3; ++j)
      for (int row = 0; row < 3; ++row) local.column[j][row] = node.matrix[size_t(4 * j + row)];
    for (int row = 0; row < 3; ++row) local.translation[row] = node.matrix[size_t(12 + row)];
    return local;
  }
  if (!node.rotation.empty()) {
    double length_squared = 0;
    for (double x : node.rotation) length_squared += x * x;
    if (!(length_squared > 0.99 && length_squared < 1.01))
      document.refuse(index, "rotation is not a quaternion of length 1");
    rotation_columns(node.rotation, local);
  }
  if (!node.scale.empty())
    for (int j = 0; j < 3; ++j)
      for (double &x : local.column[j]) x *= node.scale[size_t(j)];
  if (!node.translation.empty()) std::copy_n(node.translation.begin(), 3, local.translation);
  return local;
}

/* Tests the numbers themselves, because the square of a small one is 0. */
bool is_scaled_to_nothing(const Transform &t)
{
  return std::all_of(&t.column[0][0], &t.column[0][0] + 9, [](double x) { return x == 0; });
}

RigidPlace rigid_place(const GltfDocument &document, int index, const Transform &world, const char *what)
{
  Transform rotation = world;
  RigidPlace place;
  for (int j = 0; j < 3; ++j) {
    const double factor = length(world.column[j]);
    if (!(factor > 0) || !std::isfinite(factor))
      document.refuse(index, fmt::format("its scale is {} along {}; another than 0 along each axis is needed (0 along "
                                         "all three disables a collider)",
                                         factor, "XYZ"[j]));
    for (double &x : rotation.column[j]) x /= factor;
    place.scale[size_t(j)] = factor;
  }
  for (int j = 0; j < 3; ++j)
    if (std::abs(dot(rotation.column[j], rotation.column[(j + 1) % 3])) > 1e-4)
      document.refuse(index, fmt::format("a sheared {} (a rotation below an uneven scale) is not supported yet", what));
  if (is_mirrored(rotation)) {
    for (double &x : rotation.column[0]) x = -x;
    place.scale[0] = -place.scale[0];
  }
  place.orientation = quaternion_of(rotation.column);
  for (size_t row = 0; row < 3; ++row) place.position[row] = world.translation[row];
  return place;
}

} // namespace tandem
