/* figures.h - the figures by which stability cases are judged, each a function of one moment.
 *
 * All are computed in double precision from the states that World reports. Figures that compare with the start take the
 * scene. A body that is not finite makes a figure NaN, which passes no bound. docs/stability.md lists the figures with
 * their formulas.
 */
#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "tools/stability/trial.h"

namespace tandem::stability {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Figure = std::function<double(const Moment &)>;

inline constexpr double pi = 3.14159265358979323846;

inline Vector vector_of(const Vec3 &v) { return {v[0], v[1], v[2]}; }
inline Vector vector_of(const Point &p) { return {p[0], p[1], p[2]}; }
inline Point point_of(const Vector &v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 vec3_of(const Vector &v) { return {float(v.x()), float(v.y()), float(v.z())}; }
Matrix axes_of(const Quat &q);
Quat turn_about(const Vector &axis, double angle);

Vector moments_of(const Scene &scene, const Body &body);                             /* principal; 0 where infinite */
Vector spin_momentum(const Scene &scene, const Body &body, const BodyState &state);  /* kg m^2/s, world axes */
double kinetic_energy(const Scene &scene, const Body &body, const BodyState &state); /* J */
double mechanical_energy(const Moment &moment); /* J, kinetic and of gravity (factor included), dynamic bodies */

/* The largest over the dynamic bodies: */
Figure tilt(const Scene &scene);         /* rad, angle of the rotation since the start */
Figure sideways(const Scene &scene);     /* m, from the start, across gravity's axis y */
Figure displacement(const Scene &scene); /* m, from the start */
Figure speed();                          /* m/s, linear */
Figure penetration();                    /* m, over contact points */
Figure below(double height);             /* m, depth of a centre below y = height; 0 if none is below */

/* The gain of mechanical energy since the start, in J per kg of moving mass; negative for a loss. */
Figure energy_gain();
/* |E - E(0)| / |E(0)| of the kinetic energy, for free motion without gravity. */
Figure kinetic_energy_drift();
/* |p - p(0)| / sum of |m v| at the start, and the same for angular momentum about the origin. */
Figure linear_momentum_drift();
Figure angular_momentum_drift();
/* The same for one body, about its own centre. */
Figure spin_momentum_drift(uint32_t body);
Figure spin_energy_drift(uint32_t body);

/* |position - expected(time)| of one body. */
Figure distance_from_path(uint32_t body, std::function<Vector(double time)> expected);

/* The relative difference between the mean time between flips about body axis 1 (flip.h) and `expected`; 1 before two
 * flips. */
Figure flip_error(uint32_t body, double expected);

} // namespace tandem::stability
