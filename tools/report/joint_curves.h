/* joint_curves.h - the joints of the report: how fast the error of trees of links falls with the substep.
 *
 *   reference   M(q) q'' = -c(q, q') of the tree, a dense matrix in double, by a Runge-Kutta method of fourth order
 *   curves      the same scene in reduced coordinates, and in maximal ones with joints as stiff as the substep allows
 *   error       root mean square of the distances of all links from the reference, at each 1/60 s
 *
 * A method of first order is half as far away with half the substep, until floats end that.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tandem {

/* One scene by one method. */
struct JointCurve {
  struct Point {
    uint32_t substeps; /* of a step of 1/60 s */
    double error;      /* m */
    double substep() const;
  };
  std::string scene, method;
  std::vector<Point> points; /* from the largest substep to the smallest */

  /* The order of convergence: the slope of the logarithm of the error over that of the substep, by least squares;
   * nothing if an error is 0 or not finite. */
  std::optional<double> order() const;
};

/* "error 0.0123 m with 2 substeps of 1/60 s, 0.000383 m with 64; order of convergence 1.00" */
std::string order_sentence(const JointCurve &curve);

struct JointReport {
  std::vector<JointCurve> curves;
  double uncertainty = 0; /* m: how far the references with one and with half a step differ at most */
};

/* quick: fewer substeps, and half the time. Throws InputError for a backend that does not exist. */
JointReport joint_curves(const std::string &backend, bool quick);

} // namespace tandem
