/* coupling_errors of poses made by hand: whole turns of what has no limits are no error, and all else is. */
#include <cmath>

#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Two hinges to the world, about x. */
Scene two_hinges(const Coupling &coupling)
{
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t k = 0; k < 2; ++k) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, 0.5 * k, 0});
    connect(scene, JointType::hinge, no_body, k, vector_of(scene.bodies[k].position));
  }
  scene.couplings = {coupling};
  return scene;
}

Coupling mimic_of(double ratio, double offset = 0)
{
  Coupling mimic;
  mimic.type = CouplingType::mimic;
  mimic.joint_a = 0;
  mimic.joint_b = 1;
  mimic.ratio = float(ratio);
  mimic.offset = float(offset);
  return mimic;
}

/* angles: that the hinges have turned by, with all turns. */
double error_at(const Scene &scene, double a, double b)
{
  World world(scene, {}, {"serial", {}, false});
  PreciseBodies poses = world.precise_bodies();
  poses[0].orientation = {std::sin(a / 2), 0, 0, std::cos(a / 2)};
  poses[1].orientation = {std::sin(b / 2), 0, 0, std::cos(b / 2)};
  return coupling_errors(scene, poses).front();
}

} // namespace

TEST_CASE("coupling errors: a mimic of hinges without limits is where it belongs after any number of turns")
{
  for (const double ratio : {1.0, -1.0, -2.0, 0.5, -2.0 / 3})
    for (const double offset : {0.0, 1.0}) {
      const Scene scene = two_hinges(mimic_of(ratio, offset));
      for (double a = -40; a < 40; a += 0.73)
        for (const double off : {0.0, 0.3, -0.7}) {
          CAPTURE(ratio, offset, a, off);
          CHECK(error_at(scene, a + off, (offset - a) / double(float(ratio))) == Approx(std::abs(off)).margin(1e-5));
        }
    }
}

TEST_CASE("coupling errors: turns of a hinge that add up to anything are no excuse")
{
  for (const double ratio : {0.01, 3.71}) {
    const Scene scene = two_hinges(mimic_of(ratio));
    for (const double off : {0.0, 0.3}) CHECK(error_at(scene, off - ratio, 1) == Approx(off).margin(1e-6));
  }
}

TEST_CASE("coupling errors: a joint with limits is known to be less than a turn away")
{
  Scene scene = two_hinges(mimic_of(-2));
  for (Joint &joint : scene.joints) joint.rotations[0].lower = -3.1f, joint.rotations[0].upper = 3.1f;
  CHECK(error_at(scene, -2, 1.5) == Approx(5).margin(1e-6));
  scene.joints[0].rotations[0] = {};
  CHECK(error_at(scene, -2, 1.5) == Approx(2 * M_PI - 5).margin(1e-6)); /* b of 1.5 wants 3, a turn from -3.28 */
}

TEST_CASE("coupling errors: a gear is as far off as from the tooth beside it")
{
  Coupling gear;
  gear.joint_a = 0;
  gear.joint_b = 1;
  gear.teeth_a = 10;
  gear.teeth_b = 20;
  const Scene scene = two_hinges(gear);
  const double tooth = 2 * M_PI / 10;
  for (const auto &[slipped, off] : {std::pair(0.0, 0.0), {0.4, 0.4}, {0.6, 0.4}, {1.0, 0.0}})
    CHECK(error_at(scene, 50 + slipped * tooth, -25) == Approx(off * tooth).margin(1e-6));
}
