/* metrics.h - measures the errors of a simulation: the numbers that the report draws and the tests bound. It belongs to
 * the library Tandem::verify.
 *
 * Everything is computed in double on the host from downloaded buffers, and never inside a step, so that measuring
 * cannot change what is measured; it may be called beside other reading of the same world. docs/metrics.md states each
 * formula, its unit and its source.
 */
#pragma once

#include <array>
#include <span>
#include <vector>

#include <tandem/export.h>
#include <tandem/world.h>

namespace tandem {

using PreciseBodies = std::vector<PreciseBodyState>; /* in the order of Scene::bodies */

/* The angle between two orientations, 0 .. pi rad; it is accurate for small angles too. */
TANDEM_API double angle_between(const std::array<double, 4> &one, const std::array<double, 4> &other);

/* How far a joint is open: between the origins of its frames along the directions that it holds, and by the rotations
 * that it holds; 0 if it is not enabled. */
struct JointError {
  double distance = 0; /* m */
  double angle = 0;    /* rad */
};
TANDEM_API std::vector<JointError> joint_errors(const Scene &scene, const PreciseBodies &states);

struct JointErrorSummary {
  double max_distance = 0, mean_distance = 0; /* m */
  double max_angle = 0, mean_angle = 0;       /* rad */
};
TANDEM_API JointErrorSummary summary_of(std::span<const JointError> errors);

/* How far the coordinates of each coupling are from what it holds, in rad or m of joint_a's; of a rope, how much too
 * long its parts are. An angle is known but for whole turns, so a gear or rack that has skipped a tooth is where it
 * belongs, and so is a mimic of hinges without limits that is off by whole turns of these. */
TANDEM_API std::vector<double> coupling_errors(const Scene &scene, const PreciseBodies &states);

/* Distances between simulated and true poses over the dynamic bodies, accumulated over any number of moments. */
class TANDEM_API TrajectoryError {
public:
  void add(const Scene &scene, const PreciseBodies &states, const PreciseBodies &truth);

  double position_rms() const; /* m; 0 if nothing was added */
  double position_max() const { return position_max_; }
  double angle_rms() const; /* rad */
  double angle_max() const { return angle_max_; }

private:
  double position_squares_ = 0, angle_squares_ = 0, position_max_ = 0, angle_max_ = 0;
  size_t count_ = 0;
};

/* Sums over the dynamic bodies. The potential energy is -m g . x, which is 0 at the origin; the angular momentum is
 * about the origin. */
struct Conserved {
  double kinetic = 0, potential = 0;                    /* J */
  std::array<double, 3> momentum{}, angular_momentum{}; /* kg m/s, kg m^2/s */

  double energy() const { return kinetic + potential; }
};
TANDEM_API Conserved conserved_quantities(const Scene &scene, const PreciseBodies &states);

/* The mean height of the dynamic bodies in metres, against gravity, or along y if there is no gravity. */
TANDEM_API double mean_height(const Scene &scene, const PreciseBodies &states);

/* How far the impulses and velocities at the end of the last step are from solving its contact problem. All are
 * relative: the first two to the Euclidean norm of the impulses, the violation to the largest friction limit. All are 0
 * without contacts. Throws InputError unless keep_residuals came before that step, because other worlds spare what this
 * reads: 16 to 32 bytes a pair. */
struct StepResiduals {
  double natural_map = 0;
  double fischer_burmeister = 0;
  double cone_violation = 0;
};
TANDEM_API void keep_residuals(World &world);
TANDEM_API StepResiduals step_residuals(World &world);

/* The residual of one contact, a complementarity problem of impulse p >= 0 and relative speed u. Both arguments are in
 * N s: `mass_speed` is effective mass times speed. */
TANDEM_API double natural_map_of(double impulse, double mass_speed);
TANDEM_API double fischer_burmeister_of(double impulse, double mass_speed);

} // namespace tandem
