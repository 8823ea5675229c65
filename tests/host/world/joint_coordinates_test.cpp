/* The axes about which the coordinates of a joint change are derivatives of these coordinates: finite differences in
 * double are the oracle. An axis that is not one lets limits and springs do work that no coordinate shows. */
#include <numbers>

#include "host/base/random.h"
#include "host/world/joint_coordinates.h"
#include "shared/joints/joint_codes.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

namespace tandem::physics_tests {
namespace {

using Eigen::Quaterniond;

/* How the frames of a joint move: frame b as seen from the origin of frame a, and how fast each of them turns. */
struct FrameMotion {
  Vector closing, turning_a, turning_b;
};

struct MovingFrames {
  Vector gap;
  Quaterniond a, b;

  MovingFrames after(const FrameMotion &motion, double time) const
  {
    const auto turned = [time](const Vector &turning, const Quaterniond &from) {
      return Quaterniond(Quaterniond(Eigen::AngleAxisd(turning.norm() * time, turning.normalized())) * from);
    };
    return {gap + time * motion.closing, turned(motion.turning_a, a), turned(motion.turning_b, b)};
  }
  CoordinateOfFrames coordinate(uint32_t kind) const
  {
    const auto four = [](const Quaterniond &q) { return std::array{q.x(), q.y(), q.z(), q.w()}; };
    return coordinate_of({{gap.x(), gap.y(), gap.z()}, four(a), four(b)}, kind);
  }
};

Vector vector_of_three(const std::array<double, 3> &three) { return {three[0], three[1], three[2]}; }

Vector any_vector(Random &random, double size)
{
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Quaterniond any_rotation(Random &random)
{
  return Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
      .normalized();
}

/* What the velocities say, as shared/joints/coordinates.h has it, less what the coordinate did. */
double error_of_speed(const MovingFrames &frames, const FrameMotion &motion, uint32_t kind)
{
  constexpr double time = 3e-4; /* the arc tangent of shared/trigonometry.h is right to 1e-8 */
  const CoordinateOfFrames now = frames.coordinate(kind);
  const Vector at_b = motion.closing - motion.turning_a.cross(frames.gap);
  const double said =
      vector_of_three(now.direction).dot(at_b) + vector_of_three(now.turn).dot(motion.turning_b - motion.turning_a);
  return said -
         (frames.after(motion, time).coordinate(kind).value - frames.after(motion, -time).coordinate(kind).value) /
             (2 * time);
}

} // namespace

TEST_CASE("coordinates of joints change as their axes say, by finite differences in double")
{
  constexpr double widest_swing = 2.6; /* rad: twist and swing have no axes at half a turn */
  Random random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const Quaterniond a = any_rotation(random), relative = any_rotation(random);
    const MovingFrames frames{any_vector(random, 1), a, a * relative};
    const FrameMotion motion{any_vector(random, 2), any_vector(random, 2), any_vector(random, 2)};
    const Vector x = relative * Vector::UnitX(), y = relative * Vector::UnitY();
    const double twist = frames.coordinate(JOINT_AXIS_TWIST).value, swing = std::acos(x.x());
    for (uint32_t kind = 0; kind < JOINT_AXIS_NONE; ++kind) {
      if (kind == JOINT_AXIS_AROUND) continue; /* it has a speed alone */
      const bool swings = kind == JOINT_AXIS_TWIST || kind == JOINT_AXIS_SWING_Y || kind == JOINT_AXIS_SWING_Z ||
                          kind == JOINT_AXIS_CONE;
      const bool crosses = kind == JOINT_AXIS_TURN || kind == JOINT_AXIS_SPIN;
      const double value = frames.coordinate(kind).value;
      if (swings && (swing > widest_swing || swing < 0.05 || std::abs(twist) > 3)) continue;
      if (crosses && (std::abs(y.x()) > 0.9 || std::abs(value) > 3)) continue;
      CAPTURE(trial, kind, swing, value);
      REQUIRE(std::abs(error_of_speed(frames, motion, kind)) < 2e-4);
    }
  }
}

TEST_CASE("a turn about the axis around a cone changes neither the cone nor the twist, and moves x of b around it")
{
  Random random(11);
  for (int trial = 0; trial < 500; ++trial) {
    const Quaterniond a = any_rotation(random), relative = any_rotation(random);
    const MovingFrames frames{Vector::Zero(), a, a * relative};
    const Vector x = relative * Vector::UnitX();
    const double swing = std::acos(x.x()), twist = frames.coordinate(JOINT_AXIS_TWIST).value;
    if (swing < 0.05 || swing > 2.6 || std::abs(twist) > 3) continue;
    const Vector around = vector_of_three(frames.coordinate(JOINT_AXIS_AROUND).turn);
    constexpr double angle = 1e-4;
    const MovingFrames after = frames.after({Vector::Zero(), Vector::UnitX() * 1e-30, around}, angle);
    CAPTURE(trial, swing);
    CHECK(around.norm() == Approx(1));
    CHECK(std::abs(after.coordinate(JOINT_AXIS_CONE).value - swing) < 1e-7);
    CHECK(std::abs(after.coordinate(JOINT_AXIS_TWIST).value - twist) < 1e-7);
    const Vector moved = a.conjugate() * (after.b * Vector::UnitX()) - x;
    CHECK(moved.norm() == Approx(angle * std::cos(swing / 2)).epsilon(1e-3));
  }
}

TEST_CASE("the axes of the twist, the cone and around it stand at right angles without a swing, and at half a turn")
{
  for (const double swing : {0.0, std::numbers::pi}) {
    const MovingFrames frames{Vector::Zero(), Quaterniond::Identity(),
                              Quaterniond(Eigen::AngleAxisd(swing, Vector::UnitZ()))};
    const Vector cone = vector_of_three(frames.coordinate(JOINT_AXIS_CONE).turn),
                 around = vector_of_three(frames.coordinate(JOINT_AXIS_AROUND).turn);
    CAPTURE(swing);
    CHECK(cone.norm() == Approx(1));
    CHECK(around.norm() == Approx(1));
    CHECK(std::abs(cone.dot(around)) < 1e-6);
    CHECK(std::abs(around.x()) == Approx(swing == 0 ? 0.0 : 1.0).margin(1e-6));
  }
}

TEST_CASE("a swing about one axis alone changes as the body turns about it, to the bit")
{
  for (const double angle : {-2.0, -0.4, 0.3, 1.7}) {
    const Quaterniond about_y(Eigen::AngleAxisd(angle, Vector::UnitY())),
        about_z(Eigen::AngleAxisd(angle, Vector::UnitZ()));
    const MovingFrames swung_y{{0, 0, 0}, Quaterniond::Identity(), about_y},
        swung_z{{0, 0, 0}, Quaterniond::Identity(), about_z};
    CHECK(swung_y.coordinate(JOINT_AXIS_SWING_Y).value == Approx(angle));
    CHECK(vector_of_three(swung_y.coordinate(JOINT_AXIS_SWING_Y).turn) == Vector::UnitY());
    CHECK(swung_z.coordinate(JOINT_AXIS_SWING_Z).value == Approx(angle));
    CHECK(vector_of_three(swung_z.coordinate(JOINT_AXIS_SWING_Z).turn) == Vector::UnitZ());
  }
}

} // namespace tandem::physics_tests
