/* joints.h - joints placed in the world, for the cases that have some, and the figures that read them.
 *
 * What joints hold is compared with geometry: frames that are held together are 0 apart, and a chain is no longer than
 * its links. docs/joints.md says how joints are solved, and so how far a load opens them.
 */
#pragma once

#include "tools/stability/cases.h"

namespace tandem::stability {

inline constexpr double standard_gravity = 10; /* m/s^2, that of empty_scene */

inline Eigen::Quaterniond eigen_of(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(); }

/* Adds a joint whose frames coincide where `at` and `axes` say, in the world. */
Joint &connect(Scene &scene, JointType type, uint32_t a, uint32_t b, const Vector &at, const Eigen::Quaterniond &axes);
/* The same with the joint's axis x along `axis`. */
Joint &connect(Scene &scene, JointType type, uint32_t a, uint32_t b, const Vector &at,
               const Vector &axis = Vector::UnitX());

/* Bodies that collide with nothing, for cases of joints alone. */
void let_pass(Scene &scene);

/* Joints of a quarter of the substep rate; contacts are as with_substeps has them.
 * A load M on m opens a joint by about (M / m) g / (2 pi joint_hertz)^2, so it falls as the square of the substeps. */
Settings with_stiff_joints(uint32_t substeps);

/* What joints of these settings do under a load, an acceleration of what they move. */
struct JointSoftness {
  explicit JointSoftness(const Settings &settings);
  double stretch; /* m at 1 m/s^2 that does not change */
  double open;    /* m at 1 m/s^2 that turns, such as the pull of what circles: a substep leaves half a square */
};

/* The largest over the joints, along and about what they hold: */
Figure joint_opening();      /* m */
Figure mean_joint_opening(); /* m, their mean */
Figure joint_angle();        /* rad */
Figure coupling_slack();     /* rad or m, over the couplings */

/* How much longer than `length` the way from a point of the world to the centre of a body is, relative to `length`.
 * 0 if it is shorter. */
Figure stretch_to(uint32_t body, const Vector &from, double length);
/* The coordinate of a joint, 0 to 2 its directions and 3 to 5 its rotations, beyond a limit; 0 within. */
Figure beyond_limit(uint32_t joint, size_t coordinate, double limit);
/* The gain of mechanical energy since the start, relative to `scale` in J. */
Figure relative_energy_gain(const Scene &scene, double scale);
/* |E - E(0)| / E(0) of the mechanical energy. */
Figure mechanical_energy_drift();
/* The turn of a body about an axis of the world since the start, in rad, whole turns included. It turns by less than
 * half a turn between two moments. */
Figure turns_about(uint32_t body, const Vector &axis);

} // namespace tandem::stability
