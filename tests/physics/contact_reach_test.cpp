/* Contacts are made as far ahead of touching as <tandem/settings.h> says at Settings::slop. */
#include <algorithm>

#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

bool has_contact(const Shape &shape, double half_height, double gap, float speed, const Settings &settings)
{
  Scene scene = empty_scene({0, 0, 0});
  add_ground(scene);
  add_body(scene, BodyType::dynamic, shape, {0, half_height + gap, 0}).linear_velocity = {0, -speed, 0};
  World world(scene, settings, {"serial", {}, false});
  world.step();
  return world.statistics().manifolds == 1;
}

} // namespace

TEST_CASE("contact reach: it grows with the step as the settings say", "[physics]")
{
  for (const double step : {1.0 / 20, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000})
    for (const double slop : {0.005, 0.002})
      for (const float speed : {0.0f, 2.0f})
        for (const auto &[shape, half_height] :
             {std::pair(sphere_shape(0.5f), 0.5), std::pair(box_shape(0.5f, 0.25f, 0.5f), 0.25)}) {
          Settings settings;
          settings.step = float(step);
          settings.slop = float(slop);
          const double reach = slop * std::clamp(240 * step, 1.0, 4.0) + step * double{speed};
          CAPTURE(step, slop, speed, half_height, reach);
          CHECK(has_contact(shape, half_height, reach - 1e-4, speed, settings));
          CHECK_FALSE(has_contact(shape, half_height, reach + 1e-4, speed, settings));
        }
}
