/* metrics_test.cpp - the metrics are those that docs/metrics.md defines: values computed by hand, and a residual that
 * grows with a planted change of a velocity. */
#include <cmath>
#include <memory>

#include <tandem/metrics.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

std::array<double, 4> turn(double angle) { return {0, std::sin(angle / 2), 0, std::cos(angle / 2)}; }

/* A ball of 1 kg at rest on the ground, friction 0.6, settled. */
std::unique_ptr<World> resting_ball()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0.5f, 0});
  auto world = std::make_unique<World>(scene, settings_with(1.0 / 60, 4), Placement{"reference", {}, false});
  keep_residuals(*world);
  run(*world, 120);
  return world;
}

/* Gives the ball another velocity at the end of the step, behind the solver's back. Large bodies come first: the ground
 * is index 0. */
void set_solver_velocity(World &world, const Vec3 &linear)
{
  const float4 velocity{linear[0], linear[1], linear[2], 1.0f};
  world.memory().upload(Buffer::solver_velocity, &velocity, sizeof velocity, 2 * sizeof(float4));
}

double normal_impulse_sum_of(World &world)
{
  return world.memory().read_reals(Buffer::constraint_normal_impulse, 1).front();
}

} // namespace

TEST_CASE("metrics: the angle between orientations, also a tiny one, and with either sign", "[metrics]")
{
  for (const double angle : {0.0, 1e-12, 1e-6, 0.5, 3.0}) {
    CHECK(angle_between(turn(0), turn(angle)) == Approx(angle).margin(1e-16));
    const std::array<double, 4> q = turn(angle);
    CHECK(angle_between(turn(0), {-q[0], -q[1], -q[2], -q[3]}) == Approx(angle).margin(1e-16));
  }
}

TEST_CASE("metrics: trajectory errors are RMS and maximum over bodies that move", "[metrics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 0, 0});
  PreciseBodies truth(3), states(3);
  for (PreciseBodyState &state : truth) state.orientation = turn(0);
  states = truth;
  states[0].position = {100, 0, 0}; /* the ground does not count */
  states[1].position = {3, 0, 4};
  states[2].orientation = turn(0.2);
  TrajectoryError error;
  CHECK(error.position_rms() == 0);
  error.add(scene, states, truth);
  CHECK(error.position_rms() == Approx(std::sqrt(25.0 / 2)));
  CHECK(error.position_max() == Approx(5));
  CHECK(error.angle_rms() == Approx(0.2 / std::sqrt(2.0)));
  CHECK(error.angle_max() == Approx(0.2));
  error.add(scene, truth, truth);
  CHECK(error.position_rms() == Approx(2.5));
}

TEST_CASE("metrics: energy and momenta of a spinning, flying brick", "[metrics]")
{
  Scene scene = empty_scene({0, -10, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 1, 1.5f), {1, 2, 3}).mass = 6;
  PreciseBodies states(1);
  states[0] = {{1, 2, 3}, turn(pi / 2), {0, 3, 0}, {0, 0, 2}}; /* turned about y: its x axis points to -z */
  const Conserved sum = conserved_quantities(scene, states);
  const double moment = 6.0 / 3 * (1.0 + 2.25); /* about its own x axis */
  CHECK(sum.kinetic == Approx(0.5 * 6 * 9 + 0.5 * moment * 4));
  CHECK(sum.potential == Approx(6 * 10 * 2));
  CHECK(sum.momentum[1] == Approx(18));
  CHECK(sum.angular_momentum[0] == Approx(-3 * 18));
  CHECK(sum.angular_momentum[1] == Approx(0).margin(1e-9));
  CHECK(sum.angular_momentum[2] == Approx(1 * 18 + moment * 2));
  CHECK(mean_height(scene, states) == Approx(2));
}

TEST_CASE("metrics: residuals of one contact vanish where it is solved, and nowhere else", "[metrics]")
{
  for (const auto &residual : {natural_map_of, fischer_burmeister_of}) {
    CHECK(residual(0, 0) == 0);
    CHECK(residual(3, 0) == 0);
    CHECK(residual(0, 2) == 0);
    CHECK(std::abs(residual(1, 1)) > 0.5);  /* pressed and parting */
    CHECK(std::abs(residual(0, -1)) > 0.5); /* approaching, not pressed */
    CHECK(std::abs(residual(-1, 0)) > 0.5); /* pulled */
  }
  CHECK(natural_map_of(2, -1) == Approx(-1));
  CHECK(fischer_burmeister_of(3, 4) == Approx(2));
}

TEST_CASE("metrics: a ball at rest solves its problem, and a velocity that does not belong shows by its size",
          "[metrics]")
{
  const auto kept = resting_ball();
  World &world = *kept;
  CHECK(step_residuals(world).natural_map < 1e-9);
  CHECK(step_residuals(world).fischer_burmeister < 1e-9);
  const double normal_impulse_sum = normal_impulse_sum_of(world);
  CHECK(normal_impulse_sum == Approx(10.0 / 240).epsilon(0.01)); /* m g h of a substep */

  const double approach = 0.015625;
  set_solver_velocity(world, {0, float(-approach), 0});
  CHECK(step_residuals(world).natural_map == Approx(approach / normal_impulse_sum).epsilon(1e-6));
  CHECK(step_residuals(world).fischer_burmeister ==
        Approx((std::hypot(normal_impulse_sum, approach) - normal_impulse_sum + approach) / normal_impulse_sum)
            .epsilon(1e-6));

  set_solver_velocity(world, {0.5f, 0, 0}); /* sliding without the friction of its cone */
  CHECK(step_residuals(world).natural_map == Approx(0.6).epsilon(1e-6));
  CHECK(step_residuals(world).cone_violation == 0);
}

TEST_CASE("metrics: an impulse outside of its cone is a violation", "[metrics]")
{
  const auto kept = resting_ball();
  World &world = *kept;
  const float4 friction{float(1.5 * 0.6 * normal_impulse_sum_of(world)), 0, 0, 0};
  world.memory().upload(Buffer::constraint_friction_impulse, &friction, sizeof friction);
  CHECK(step_residuals(world).cone_violation == Approx(0.5).epsilon(1e-5));
  CHECK(step_residuals(world).natural_map > 0.1);
}

TEST_CASE("metrics: a box that slides keeps its friction on the cone, against the sliding", "[metrics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.2f, 0.5f), {0, 0.2f, 0}).linear_velocity = {3, 0, 1};
  for (const char *backend : {"reference", "serial", "tbb:threads=2,lanes=4"}) {
    World world(scene, settings_with(1.0 / 60, 4), {backend, {}, false});
    keep_residuals(world);
    run(world, 10);
    CAPTURE(backend);
    const StepResiduals residuals = step_residuals(world);
    CHECK(residuals.natural_map < 0.05);
    CHECK(residuals.fischer_burmeister < 0.05);
    CHECK(residuals.cone_violation < 0.05);
  }
}

TEST_CASE("metrics: residuals of a step that has not kept its contacts are refused, and change no bit", "[metrics]")
{
  const Scene scene = load_scene("box-stack:n=20");
  World plain(scene, {}, {"serial", {}}), kept(scene, {}, {"serial", {}});
  keep_residuals(kept);
  for (World *world : {&plain, &kept}) world->step();
  CHECK_THROWS_AS(step_residuals(plain), InputError);
  CHECK(step_residuals(kept).natural_map > 0);
  CHECK(plain.state_hash() == kept.state_hash());
  CHECK(plain.memory().total_bytes() < kept.memory().total_bytes());
  keep_residuals(plain);
  for (World *world : {&plain, &kept}) world->step();
  CHECK(step_residuals(plain).natural_map == step_residuals(kept).natural_map);
}

TEST_CASE("metrics: nothing touches, nothing is left over", "[metrics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 0, 0});
  World world(scene, {}, {"serial", {}, false});
  run(world, 2);
  CHECK(step_residuals(world).natural_map == 0);
  CHECK(step_residuals(world).fischer_burmeister == 0);
}
