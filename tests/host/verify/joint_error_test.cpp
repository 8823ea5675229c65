/* joint_errors of poses made by hand: what a type holds counts, and what it leaves free does not. */
#include <cmath>
#include <map>

#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Two bodies in any poses with a closed joint between them; then body b moves by `way` along the axes of frame a, and
 * turns about frame b by `angle` about `axis`, in axes of frame a. */
JointError error_of(JointType type, const Vector &way, const Vector &axis, double angle, bool to_world)
{
  Random random(5);
  Scene scene = empty_scene();
  for (int i = 0; i < 2; ++i) {
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.5f), point_of(3 * direction(random)));
    body.orientation = any_turn(random);
  }
  const Vector at(0.5, -0.25, 2);
  connect(scene, type, to_world ? no_body : 0, 1, at, {1, 2, 3});
  World world(scene, {}, {"reference", {}});
  PreciseBodies poses = world.precise_bodies();
  const Eigen::Quaterniond axes = turn_of_x_to({1, 2, 3});
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Vector(axes * axis.normalized())));
  const Vector center = at + turn * (Vector(poses[1].position.data()) - at) + axes * way;
  const auto &q = poses[1].orientation;
  const Eigen::Quaterniond turned = turn * Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  poses[1].position = point_of(center);
  poses[1].orientation = {turned.x(), turned.y(), turned.z(), turned.w()};
  const std::vector<JointError> errors = joint_errors(scene, poses);
  REQUIRE(errors.size() == 1);
  return errors.front();
}

} // namespace

TEST_CASE("the errors of joints are what their types hold, of poses made by hand")
{
  const std::map<JointType, std::string> freedoms = {{JointType::ball, "---xyz"},        {JointType::fixed, "------"},
                                                     {JointType::hinge, "---x--"},       {JointType::slider, "x-----"},
                                                     {JointType::cylindrical, "x--x--"}, {JointType::plane, "-yzx--"},
                                                     {JointType::parallel, "xyzx--"}};
  const bool to_world = GENERATE(false, true);
  const auto near = [](double x) { return Approx(x).margin(1e-6); }; /* frames are floats */
  for (const auto &[type, free] : freedoms)
    for (int k = 0; k < 6; ++k) {
      CAPTURE(name_of_type(type), k, to_world);
      const Vector axis = Vector::Unit(k % 3);
      const JointError error =
          k < 3 ? error_of(type, 0.3 * axis, axis, 0, to_world) : error_of(type, Vector::Zero(), axis, 0.7, to_world);
      const bool held = free[size_t(k)] == '-';
      CHECK(error.distance == near(k < 3 && held ? 0.3 : 0));
      CHECK(error.angle == near(k >= 3 && held ? 0.7 : 0));
    }
}

TEST_CASE("the errors of joints add up over directions, and turns count beyond half a circle")
{
  const auto near = [](double x) { return Approx(x).margin(1e-6); };
  CHECK(error_of(JointType::ball, {0.2, -0.3, 0.6}, {1, 0, 0}, 1, false).distance == near(0.7));
  CHECK(error_of(JointType::slider, {0.2, -0.3, 0.4}, {1, 0, 0}, 0, false).distance == near(0.5));
  CHECK(error_of(JointType::plane, {-0.2, 5, 7}, {1, 0, 0}, 3, false).distance == near(0.2));
  CHECK(error_of(JointType::fixed, {0, 0, 0}, {1, 2, -1}, 4, false).angle == near(2 * pi - 4));
  CHECK(error_of(JointType::fixed, {0, 0, 0}, {1, 2, -1}, pi, true).angle == near(pi));
  CHECK(error_of(JointType::hinge, {0, 0, 0}, {0, 1, 0}, 3, false).angle == near(3));
  /* Half a turn about an axis that is half-way between x and y takes x to y. */
  CHECK(error_of(JointType::hinge, {0, 0, 0}, {1, 1, 0}, pi, false).angle == near(pi / 2));
}

TEST_CASE("a universal joint is open by how far its axes are from a right angle")
{
  const auto near = [](double x) { return Approx(x).margin(1e-6); };
  CHECK(error_of(JointType::universal, {0, 0, 0}, {1, 0, 0}, 2, false).angle == near(0));
  CHECK(error_of(JointType::universal, {0, 0, 0}, {0, 1, 0}, 2, false).angle == near(0));
  CHECK(error_of(JointType::universal, {0, 0, 0}, {0, 0, 1}, 0.3, false).angle == near(0.3));
}

TEST_CASE("the summary of joint errors has the largest and the mean, and zeros without joints")
{
  const std::vector<JointError> errors = {{0.5, 0}, {0.25, 0.3}, {0, 0.1}};
  const JointErrorSummary summary = summary_of(errors), none = summary_of({});
  CHECK(summary.max_distance == 0.5);
  CHECK(summary.mean_distance == Approx(0.25));
  CHECK(summary.max_angle == 0.3);
  CHECK(summary.mean_angle == Approx(0.4 / 3));
  CHECK((none.max_distance == 0 && none.mean_distance == 0 && none.max_angle == 0 && none.mean_angle == 0));
}
