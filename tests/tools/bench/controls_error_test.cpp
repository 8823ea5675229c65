/* `tandem bench controls --error` counts the worlds of a robot that explodes, and measures the others. */
#include <cmath>

#include "tests/catch.h"
#include "tests/physics/joints.h"
#include "tools/bench/controls_error.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A ball of 1 kg on a slider, which a stiff spring pulls to places up to so many metres away. */
ControlsError error_of_pulled_ball(float way)
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0, 0}).mass = 1;
  connect(scene, JointType::slider, no_body, 0, {0, 0, 0}).directions[0].stiffness = 1000;
  Actuator actuator;
  actuator.axis = 0;
  actuator.sets = Control::target_position;
  actuator.lower = -way;
  actuator.upper = way;
  Settings settings;
  settings.step = 0.005f;
  settings.substeps = 1;
  return controls_error(scene, std::vector{actuator}, 32, settings, {"serial", {}, false});
}

uint32_t most_left(const ControlsError &error)
{
  uint32_t most = 0;
  for (const ErrorOfStep &step : error.steps)
    for (const DistanceOfWorlds &distance : step.distances) most = std::max(most, distance.left);
  return most;
}

} // namespace

TEST_CASE("controls error: of robots that stay in the range all worlds are measured")
{
  const ControlsError error = error_of_pulled_ball(0.1f);
  CHECK(error.size == Approx(std::sqrt(3.0)));
  CHECK(most_left(error) == 0);
  CHECK(text_of(error).find("left") == std::string::npos);
  CHECK(error.steps.front().distances.back().median > 0);
}

TEST_CASE("controls error: worlds that are off by more than the scene are counted, and the rest is measured")
{
  const ControlsError error = error_of_pulled_ball(5);
  CHECK(most_left(error) > 4);
  CHECK(most_left(error) < 32);
  for (const ErrorOfStep &step : error.steps)
    for (const DistanceOfWorlds &distance : step.distances) CHECK(distance.ninetieth <= 1e3 * error.size);
  CHECK(text_of(error).find("left") != std::string::npos);
  CHECK(json_of(error)["steps"][0]["distance_mm"][3]["left"] == error.steps[0].distances[3].left);
}

TEST_CASE("controls error: of robots that all explode none is measured")
{
  for (const float way : {1e6f, 1e34f}) {
    const ControlsError error = error_of_pulled_ball(way);
    CHECK(error.steps.front().distances.back().left == 32);
    CHECK(std::isnan(error.steps.front().distances.back().median));
    CHECK(json_of(error)["steps"][0]["distance_mm"][3]["median"].is_null());
    CHECK(text_of(error).find(" 32 left") != std::string::npos);
  }
}
