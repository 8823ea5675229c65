/* metrics.h - how wrong a simulation is, in numbers: what the report draws and the tests bound; of the library
 * Tandem::verify.
 *
 * Everything is computed in double on the host from downloaded buffers, and never inside a step: measuring cannot
 * change what is measured. docs/metrics.md states each formula, its unit and where it comes from.
 */
#pragma once

#include <array>
#include <vector>

#include <tandem/export.h>
#include <tandem/world.h>

namespace tandem {

using PreciseBodies = std::vector<PreciseBodyState>; /* in the order of Scene::bodies */

/* The angle between two orientations, 0 .. pi rad; exact for small angles too. */
TANDEM_API double angle_between(const std::array<double, 4> &one, const std::array<double, 4> &other);

/* Distances from the truth over dynamic bodies, gathered over any number of moments. */
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

/* Sums over dynamic bodies. Potential: -m g . x, 0 at the origin. Angular momentum: about the origin. */
struct Conserved {
  double kinetic = 0, potential = 0;                    /* J */
  std::array<double, 3> momentum{}, angular_momentum{}; /* kg m/s, kg m^2/s */

  double energy() const { return kinetic + potential; }
};
TANDEM_API Conserved conserved_quantities(const Scene &scene, const PreciseBodies &states);

/* Mean height (against gravity; y without gravity) of the dynamic bodies, m. */
TANDEM_API double mean_height(const Scene &scene, const PreciseBodies &states);

/* How far the impulses and velocities at the end of the last step are from solving its contact problem. All relative:
 * to the Euclidean norm of the impulses, the violation to the largest limit of friction. 0 without contacts. */
struct StepResiduals {
  double natural_map = 0;
  double fischer_burmeister = 0;
  double cone_violation = 0;
};
TANDEM_API StepResiduals step_residuals(World &world);

/* One contact of a problem in impulses: normal p >= 0 and speed u, complementary. Both in N s: `mass_speed` is
 * effective mass x speed. */
TANDEM_API double natural_map_of(double impulse, double mass_speed);
TANDEM_API double fischer_burmeister_of(double impulse, double mass_speed);

} // namespace tandem
