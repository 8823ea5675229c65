/* closed_forms_test.cpp - the exact motions, checked against physics they were not written from, and the simulation
 * against them. */
#include <algorithm>
#include <cmath>

#include <tandem/metrics.h>

#include "host/catalog/closed_forms.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

PreciseBodyState exact(const Scene &scene, size_t body, double time)
{
  return closed_form_state(scene, time).value().at(body);
}

double worst_position(const std::string &specification, const Settings &settings, const std::string &backend, int steps)
{
  const Scene scene = load_scene(specification);
  World world(scene, settings, {backend, {}, false});
  for (int k = 0; k < steps; ++k) world.step();
  TrajectoryError error;
  error.add(scene, world.precise_bodies(), closed_form_state(scene, steps * double{settings.step}).value());
  return error.position_max();
}

Settings fine(double step)
{
  Settings settings;
  settings.step = float(step);
  settings.substeps = 4;
  return settings;
}

} // namespace

TEST_CASE("closed form: a ball returns to restitution squared of its height, at the time of free fall", "[closed-form]")
{
  const Scene scene = load_scene("bounce:n=1,restitution=0.5,height=5,radius=0.25");
  const double fall = 1; /* sqrt(2 h / g) */
  CHECK(exact(scene, 1, fall - 1e-9).position[1] == Approx(0.25).margin(1e-7));
  CHECK(exact(scene, 1, fall - 1e-9).linear_velocity[1] == Approx(-10));
  CHECK(exact(scene, 1, fall + 1e-9).linear_velocity[1] == Approx(5));
  CHECK(exact(scene, 1, fall + 0.5).position[1] == Approx(0.25 + 0.25 * 5)); /* e^2 h, at rest */
  CHECK(exact(scene, 1, fall + 0.5).linear_velocity[1] == Approx(0).margin(1e-9));
  CHECK(exact(scene, 1, fall + 1 + 0.25).position[1] == Approx(0.25 + 5.0 / 16));
  CHECK(exact(scene, 1, 100).position[1] == Approx(0.25)); /* the bounces end after finite time */
}

TEST_CASE("closed form: a slope of 3:4 with friction 0.3 gives 3.6 m/s2, steeper friction holds", "[closed-form]")
{
  const Scene scene = load_scene("incline:slope=0.75,friction=0.3");
  const PreciseBodyState start = exact(scene, 1, 0), end = exact(scene, 1, 2);
  const double along = std::hypot(end.position[0] - start.position[0], end.position[1] - start.position[1]);
  CHECK(along == Approx(0.5 * 3.6 * 4).epsilon(1e-6));
  CHECK(end.position[0] - start.position[0] == Approx(0.8 * along).epsilon(1e-6));
  CHECK(end.position[1] - start.position[1] == Approx(-0.6 * along).epsilon(1e-6));
  const Scene held = load_scene("incline:slope=0.75,friction=0.8");
  CHECK(exact(held, 1, 2).position == exact(held, 1, 0).position);
}

TEST_CASE("closed form: other scenes have none", "[closed-form]")
{
  CHECK_FALSE(closed_form_state(load_scene("mass-ratio"), 1));
  CHECK_FALSE(closed_form_state(load_scene("pyramid:rows=2"), 1));
}

TEST_CASE("closed form: free flight is met to rounding, by float and by double", "[closed-form]")
{
  CHECK(worst_position("free-flight:n=4", fine(1.0 / 60), "reference", 60) < 1e-11);
  CHECK(worst_position("free-flight:n=4", Settings{}, "serial", 60) < 1e-4);
}

TEST_CASE("closed form: the reference slides down the slope with an error of first order in the step", "[closed-form]")
{
  const double coarse = worst_position("incline", fine(1.0 / 64), "reference", 64),
               fine_error = worst_position("incline", fine(1.0 / 256), "reference", 256);
  CHECK(coarse < 0.02);
  CHECK(std::log2(coarse / fine_error) / 2 == Approx(1).margin(0.15));
}

TEST_CASE("closed form: bounces are met within a few millimetres at a small step", "[closed-form]")
{
  CHECK(worst_position("bounce:n=4,height=1", fine(1.0 / 1024), "reference", 1024) < 0.01);
}

TEST_CASE("closed form: a column of growing masses starts as it is described", "[closed-form]")
{
  const Scene scene = load_scene("mass-ratio:n=4,ratio=10");
  REQUIRE(scene.bodies.size() == 5);
  for (size_t i = 1; i < 5; ++i) {
    CHECK(scene.bodies[i].mass == Approx(std::pow(10.0, double(i) - 1)));
    CHECK(scene.bodies[i].position[1] == Approx(0.5 + double(i) - 1));
  }
}
