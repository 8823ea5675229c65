/* joint_curves_test.cpp - the joints of `tandem report`: two methods that share no code come to one motion, with the
 * order of the step. */
#ifdef TANDEM_COMMAND
#include <cmath>

#include <fmt/format.h>

#include "tests/catch.h"
#include "tools/report/joint_curves.h"

using namespace tandem;

TEST_CASE("report: the order of convergence is the slope of the errors", "[report]")
{
  for (const double slope : {1.0, 2.0, 4.0}) {
    JointCurve curve{"scene", "method", {}};
    for (const uint32_t substeps : {1u, 2u, 8u, 16u})
      curve.points.push_back({substeps, 0.3 * std::pow(substeps, -slope)});
    REQUIRE(curve.order());
    CHECK(*curve.order() == Approx(slope));
    CHECK(order_sentence(curve).ends_with(fmt::format("order of convergence {:.2f}", slope)));
    curve.points.back().error = std::nan("");
    CHECK(!curve.order());
    curve.points.back().error = 0;
    CHECK(order_sentence(curve).ends_with("no order of convergence"));
  }
}

TEST_CASE("report: trees in reduced and in maximal coordinates come to the dense solution with the order of the step",
          "[report]")
{
  const JointReport report = joint_curves("serial", false);
  REQUIRE(report.curves.size() == 4);
  CHECK(report.uncertainty > 0);
  CHECK(report.uncertainty < 1e-10);
  for (const JointCurve &curve : report.curves) {
    CAPTURE(curve.scene, curve.method);
    REQUIRE(curve.points.size() == 6);
    for (size_t k = 1; k < curve.points.size(); ++k) {
      CAPTURE(k);
      CHECK(curve.points[k].error < 0.6 * curve.points[k - 1].error);
    }
    CHECK(curve.points.back().error < 5e-4);
    CHECK(*curve.order() > 0.9);
    if (curve.method == "reduced coordinates") CHECK(*curve.order() < 1.1);
  }
}
#endif
