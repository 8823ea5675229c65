/* Linkages against their closed forms: the crank-rocker of the built-in scene `four-bar` by Freudenstein's equation,
 * and Watt's linkage by the equation of its curve. What pins are open bounds what the links may be off. */
#include <tandem/load_scene.h>
#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

double openings_of(World &world)
{
  double sum = 0;
  for (const JointError &error : joint_errors(world.scene(), world.precise_bodies())) sum += error.distance;
  return sum;
}

/* Joints as stiff as these substeps allow; what they give way falls with the square of their number. */
Settings settings_of_linkage(uint32_t substeps)
{
  Settings settings = settings_with(1.0 / 60, substeps);
  settings.joint_hertz = 15 * float(substeps);
  return settings;
}

/* a: crank, b: coupler, c: rocker, d: ground. */
struct FourBar {
  double a, b, c, d;

  /* Freudenstein: K1 cos(rocker) - K2 cos(crank) + K3 = cos(crank - rocker), solved for the branch in which the rocker
   * is on the left of the line from the crank's end to its own hinge. */
  double rocker_at(double crank) const
  {
    const double k1 = d / a, k2 = d / c, k3 = (a * a - b * b + c * c + d * d) / (2 * a * c);
    const double x = std::cos(crank) - k1, y = std::sin(crank);
    return std::atan2(y, x) - std::acos((k3 - k2 * std::cos(crank)) / std::hypot(x, y));
  }
  /* Of the angle between coupler and rocker; an opening e of the pins turns the rocker by at most e / (c sine). */
  double sine_of_transmission(double crank) const
  {
    const double across = a * a + d * d - 2 * a * d * std::cos(crank), cosine = (b * b + c * c - across) / (2 * b * c);
    return std::sqrt(1 - cosine * cosine);
  }
};

/*    A----B              arms of 1 m on hinges in A and D, a bar of 0.5 m between their ends, whose middle M draws a
 *         M              curve that is nearly straight
 *         C----D
 */
struct WattLinkage {
  double arm = 1, half_bar = 0.25;

  Scene scene() const
  {
    Scene scene = empty_scene({0, 0, 0});
    const auto add_bar = [&](double half, const Vector &at) -> Body & {
      Body &bar = add_body(scene, BodyType::dynamic, box_shape(float(half), 0.03f, 0.03f), point_of(at));
      bar.filter_mask = 0;
      return bar;
    };
    add_bar(0.5 * arm, {-0.5 * arm, half_bar, 0});
    add_bar(0.5 * arm, {0.5 * arm, -half_bar, 0});
    add_bar(half_bar, {0, 0, 0}).orientation = turn_about(Vector::UnitZ(), pi / 2);
    connect(scene, JointType::hinge, no_body, 0, {-arm, half_bar, 0}, Vector::UnitZ());
    connect(scene, JointType::hinge, no_body, 1, {arm, -half_bar, 0}, Vector::UnitZ());
    connect(scene, JointType::hinge, 0, 2, {0, half_bar, 0}, Vector::UnitZ());
    connect(scene, JointType::hinge, 1, 2, {0, -half_bar, 0}, Vector::UnitZ());
    return scene;
  }
  /* M, from the angle of the arm AB: C is where circles about B and D meet. */
  Eigen::Vector2d middle_at(double angle) const
  {
    const Eigen::Vector2d b(-arm + arm * std::cos(angle), half_bar + arm * std::sin(angle)), d(arm, -half_bar);
    const Eigen::Vector2d between = d - b, across(between.y(), -between.x());
    const double squared = between.squaredNorm(), share = 0.5 * (1 + (4 * half_bar * half_bar - arm * arm) / squared),
                 side = std::sqrt(4 * half_bar * half_bar / squared - share * share);
    return 0.5 * (b + b + share * between + side * across);
  }
  /* The equation of the curve in polar coordinates about the middle between A and D, with A at the angle 0:
   * r^2 = arm^2 - (a sin t +- sqrt(c^2 - a^2 cos^2 t))^2; a: half of AD, c: half of BC. */
  double off_curve(const Eigen::Vector2d &m) const
  {
    const double a = std::hypot(arm, half_bar), t = std::atan2(m.y(), m.x()) - std::atan2(half_bar, -arm),
                 root = std::sqrt(half_bar * half_bar - a * a * std::cos(t) * std::cos(t));
    double least = 10;
    for (const double sign : {-1.0, 1.0}) {
      const double inner = a * std::sin(t) + sign * root;
      least = std::min(least, std::abs(m.squaredNorm() - arm * arm + inner * inner));
    }
    return least;
  }
};

} // namespace

TEST_CASE("four-bar: the rocker is where Freudenstein's equation has it, over several turns", "[physics]")
{
  const auto [linkage, speed] =
      GENERATE(std::pair(FourBar{0.2, 0.7, 0.5, 0.6}, 3.0), std::pair(FourBar{0.2, 0.7, 0.5, 0.6}, -5.0),
               std::pair(FourBar{0.3, 1, 0.8, 0.9}, 2.0));
  const uint32_t substeps = GENERATE(4u, 16u);
  World world(load_scene("four-bar:crank=" + std::to_string(linkage.a) + ",coupler=" + std::to_string(linkage.b) +
                         ",rocker=" + std::to_string(linkage.c) + ",ground=" + std::to_string(linkage.d) +
                         ",speed=" + std::to_string(speed)),
              settings_of_linkage(substeps), {});
  double turned = 0, last = 0, worst = 0, worst_bound = 0, least = 10, most = 0;
  for (int k = 0; k < 900; ++k) {
    world.step();
    const double crank = world.read_joint(world.id_of_joint(0)).rotations[0],
                 rocker = world.read_joint(world.id_of_joint(3)).rotations[0];
    const double error = std::abs(std::remainder(rocker - linkage.rocker_at(crank), 2 * pi)),
                 bound = openings_of(world) / (linkage.c * linkage.sine_of_transmission(crank)) + 2e-6;
    REQUIRE(error < bound);
    worst = std::max(worst, error);
    worst_bound = std::max(worst_bound, bound);
    least = std::min(least, rocker);
    most = std::max(most, rocker);
    turned += std::remainder(crank - last, 2 * pi);
    last = crank;
  }
  CAPTURE(worst, worst_bound, turned, least, most);
  CHECK(turned == Approx(speed * 15).epsilon(0.04 / substeps));  /* the motor holds its speed, to first order */
  CHECK(worst < 0.04 * std::abs(speed) / (substeps * substeps)); /* the joints are of second order */
  /* the ends of the swing: crank and coupler in one line */
  const auto end = [&](double reach) {
    const auto &[a, b, c, d] = linkage;
    return pi - std::acos((c * c + d * d - reach * reach) / (2 * c * d));
  };
  CHECK(least == Approx(end(linkage.b + linkage.a)).margin(0.01));
  CHECK(most == Approx(end(linkage.b - linkage.a)).margin(0.01));
}

TEST_CASE("watt's linkage: the middle of its bar draws the curve of Watt, which is nearly straight", "[physics]")
{
  const WattLinkage watt;
  double off_line = 0; /* how far the curve is from a straight line */
  for (double angle = -0.4; angle < 0.401; angle += 0.01) {
    const Eigen::Vector2d m = watt.middle_at(angle);
    off_line = std::max(off_line, std::abs(m.x()));
    if (m.norm() > 0.1) REQUIRE(watt.off_curve(m) < 1e-9); /* both closed forms are one */
  }
  REQUIRE(off_line < 0.01);
  const uint32_t substeps = GENERATE(4u, 16u);
  World world(watt.scene(), settings_of_linkage(substeps), {});
  double highest = 0, lowest = 0, widest = 0, worst = 0, open = 0;
  for (int k = 0; k < 480; ++k) {
    const double aim = 0.38 * std::sin(2 * pi * k / 240);
    world.set_joint_axis(world.id_of_joint(0), 3, {.target_position = float(aim), .stiffness = 60, .damping = 12});
    world.step();
    const Point at = world.precise_bodies()[2].position;
    const double angle = world.read_joint(world.id_of_joint(0)).rotations[0],
                 off = (Eigen::Vector2d(at[0], at[1]) - watt.middle_at(angle)).norm(), opening = openings_of(world);
    REQUIRE(off < 2 * opening + 1e-6);
    highest = std::max(highest, at[1]);
    lowest = std::min(lowest, at[1]);
    widest = std::max(widest, std::abs(at[0]));
    worst = std::max(worst, off);
    open = std::max(open, opening);
  }
  CAPTURE(substeps, off_line, highest, lowest, widest, worst, open);
  CHECK(highest > 0.3);
  CHECK(lowest < -0.3);
  CHECK(widest < off_line + worst);
  CHECK(worst < 5e-3 / (substeps * substeps));
}
