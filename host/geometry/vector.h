/* vector.h - Eigen's vectors for the arrays of the interfaces: inside host/geometry alone, so that no interface needs Eigen. */
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "host/geometry/geometry.h"

namespace tandem {

using Vector = Eigen::Vector3d;

inline Vector vector_of(const Vec3 &v) { return {double(v[0]), double(v[1]), double(v[2])}; }
inline Vector vector_of(const Double3 &v) { return {v[0], v[1], v[2]}; }
inline Double3 array_of(const Vector &v) { return {v.x(), v.y(), v.z()}; }

} // namespace tandem
