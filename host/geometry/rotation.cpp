/* rotation.cpp - the quaternion of a rotation matrix; see rotation.h. */
#include "host/geometry/rotation.h"

namespace tandem {

Rotation rotation_of(const Matrix &m)
{
  Rotation q;
  if (m.trace() > 0) {
    const double s = 2 * std::sqrt(1 + m.trace());
    q = {(m.at[2][1] - m.at[1][2]) / s, (m.at[0][2] - m.at[2][0]) / s, (m.at[1][0] - m.at[0][1]) / s, s / 4};
  } else {
    int i = m.at[1][1] > m.at[0][0] ? 1 : 0;
    if (m.at[2][2] > m.at[i][i]) i = 2;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * std::sqrt(1 + m.at[i][i] - m.at[j][j] - m.at[k][k]);
    q[size_t(i)] = s / 4;
    q[size_t(j)] = (m.at[i][j] + m.at[j][i]) / s;
    q[size_t(k)] = (m.at[i][k] + m.at[k][i]) / s;
    q[3] = (m.at[k][j] - m.at[j][k]) / s;
  }
  q = unit(q);
  return q[3] < 0 ? Rotation{-q[0], -q[1], -q[2], -q[3]} : q;
}

} // namespace tandem
