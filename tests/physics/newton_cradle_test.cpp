/* Newton's cradle: as many balls leave at one end as arrive at the other, and the others stay nearly where they are. */
#include <tandem/load_scene.h>
#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr double cradle_length = 4, cradle_angle = 0.7; /* m, rad: of the scene as it is */
constexpr uint32_t first_ball = 2;                      /* after the ground and the frame */

/* The angle of each ball's rods from the vertical, in rad; above 0 to the right. */
std::vector<double> angles_of_cradle(World &world)
{
  std::vector<double> angles;
  const auto states = world.precise_bodies();
  for (size_t ball = first_ball; ball < states.size(); ++ball) {
    const Joint &rod = world.scene().joints[2 * (ball - first_ball)];
    angles.push_back(
        std::atan2(states[ball].position[0] - rod.position_a[0], states[1].position[1] - states[ball].position[1]));
  }
  return angles;
}

/* Of a ball above its lowest place, as a share of that from which balls are let go. */
double share_of_height(double angle) { return (1 - std::cos(angle)) / (1 - std::cos(cradle_angle)); }

/* What the balls do from half a second after the first impact until half a second before the balls come back: the
 * highest that each reaches, as a share of the height from which balls are let go. */
std::vector<double> highest_after_impact(const std::string &scene, const Settings &settings = {})
{
  World world(load_scene(scene), settings, {});
  const double period = 2 * pi * std::sqrt(cradle_length / gravity), step = double{settings.step};
  std::vector<double> highest(world.scene().bodies.size() - first_ball);
  for (int k = 1; k * step < 0.75 * period - 0.5; ++k) {
    world.step();
    if (k * step < 0.25 * period + 0.5) continue;
    const std::vector<double> angles = angles_of_cradle(world);
    for (size_t ball = 0; ball < highest.size(); ++ball)
      highest[ball] = std::max(highest[ball], share_of_height(angles[ball]));
  }
  return highest;
}

} // namespace

TEST_CASE("newton-cradle: as many balls leave as arrive, with their speed, and the others nearly rest", "[physics]")
{
  const auto [n, raised] = GENERATE(std::pair(2, 1), std::pair(5, 1), std::pair(5, 2), std::pair(5, 3));
  const auto highest =
      highest_after_impact("newton-cradle:n=" + std::to_string(n) + ",raised=" + std::to_string(raised));
  for (int ball = 0; ball < n; ++ball) {
    CAPTURE(n, raised, ball, highest[size_t(ball)]);
    if (ball >= n - raised) CHECK(highest[size_t(ball)] > 0.95);
    else CHECK(highest[size_t(ball)] < 0.01);
    CHECK(highest[size_t(ball)] < 1);
  }
}

TEST_CASE("newton-cradle: balls without a gap do not pass an impact on, and short steps need less of one", "[physics]")
{
  CHECK(highest_after_impact("newton-cradle:gap=0").back() < 0.8);
  CHECK(highest_after_impact("newton-cradle:gap=0.01").back() < 0.9);
  CHECK(highest_after_impact("newton-cradle:gap=0.01", settings_with(1.0 / 240)).back() > 0.95);
}

TEST_CASE("newton-cradle: the balls at the ends swing in turn, and no energy is gained", "[physics]")
{
  World world(load_scene("newton-cradle"), {}, {});
  const auto energy = [&] { return conserved_quantities(world.scene(), world.precise_bodies()).energy(); };
  const double hanging = [&] { /* of all balls at their lowest */
                               double sum = 0;
                               for (size_t ball = first_ball; ball < world.scene().bodies.size(); ++ball)
                                 sum += double{world.scene().bodies[ball].mass} * gravity *
                                        (world.scene().bodies[1].position[1] - cradle_length);
                               return sum;
  }();
  const double start = energy() - hanging;
  int swings = 0; /* of the balls at the ends in turn */
  double highest = 0, least = 1;
  for (int k = 0; k < 520; ++k) {
    world.step();
    const std::vector<double> angles = angles_of_cradle(world);
    const double share = (energy() - hanging) / start, outer = swings % 2 == 0 ? angles.back() : -angles.front();
    highest = std::max(highest, share);
    least = std::min(least, share);
    if (outer > 0.4 && std::abs(angles[2]) < 0.1) ++swings;
  }
  CAPTURE(highest, least, swings);
  CHECK(highest < 1 + std::sqrt(gravity / cradle_length) / 240); /* the integrator's first order */
  CHECK(least > 0.95);
  CHECK(swings == 4); /* in two periods of 4 s */
}
