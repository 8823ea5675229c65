/* bench_controls_test.cpp - the real program: `tandem bench controls` drives robots, refuses bad use in one line. */
#ifdef TANDEM_COMMAND
#include <fstream>

#include "tests/tools/command/command_line.h"

using namespace command_line;

TEST_CASE("command: bench controls drives the hinges that have damping", "[command]")
{
  const Json json = json_of("bench controls --n 4 --steps 2 --on serial");
  check_keys(json, {"what", "backend", "robots"});
  REQUIRE(json["robots"].size() == 1);
  const Json &robot = json["robots"][0];
  check_keys(robot, {"scene", "worlds", "controls", "set_ms", "step_ms", "world_steps_per_second", "contact_points"});
  CHECK(robot["worlds"] == 4);
  CHECK(robot["controls"] == 4); /* knees and elbows of the built-in person, whose other joints are balls */
  CHECK(robot["step_ms"].get<double>() > 0);
  CHECK(robot["contact_points"].get<double>() > 0); /* it has fallen */
}

TEST_CASE("command: bench controls drives the actuators of a robot that has some", "[command]")
{
  const Scratch scratch;
  const std::string robot = scratch.file("finger.xml");
  std::ofstream(robot) << R"(<mujoco><worldbody><body><joint name="base"/><geom size="0.1"/><body pos="0 0 1">
    <joint name="tip" damping="1"/><geom size="0.1"/></body></body></worldbody>
    <actuator><motor joint="base" gear="3" ctrlrange="0 0.5"/></actuator></mujoco>)";
  const Json json = json_of("bench controls --n 2 --steps 1 --on serial --scene '" + robot + "'");
  CHECK(json["robots"][0]["controls"] == 1); /* not the hinge with damping */
}

/* The median distance in mm from the run that has converged, of the run-th step at one of the times. */
static double median_distance(const Json &error, size_t run, size_t time)
{
  return error["steps"].at(run)["distance_mm"].at(time)["median"].get<double>();
}

TEST_CASE("command: bench controls --error of a fall under a constant force is that of its integrator", "[command]")
{
  const Scratch scratch;
  const std::string robot = scratch.file("fall.xml");
  std::ofstream(robot) << R"(<mujoco><option gravity="0 0 -10"/><worldbody><body>
    <joint name="fall" type="slide" axis="0 0 1"/><geom size="0.1" mass="1"/></body></worldbody>
    <actuator><motor joint="fall" ctrlrange="2 2"/></actuator></mujoco>)";
  const Json json = json_of("bench controls --n 3 --steps 1 --on reference --error --scene '" + robot + "'");
  const Json &error = json["robots"][0]["error"];
  check_keys(error, {"worlds", "bodies", "controls_held_ms", "converged_step_ms", "steps"});
  CHECK(error["worlds"] == 3);
  CHECK(error["bodies"] == 1);
  REQUIRE(error["steps"].size() == 3);
  /* Velocities are exact after each step, and places are off by a h t / 2. Later the roundings of thousands of steps of
   * equal acceleration, which add up, would show. */
  const double converged = 5.0 / 32, times[] = {0.1, 0.2}, steps[] = {5, 2.5, 5.0 / 16};
  for (size_t run = 0; run < 3; ++run)
    for (size_t time = 0; time < 2; ++time) {
      const Json &at = error["steps"][run]["distance_mm"].at(time);
      CHECK(at["seconds"].get<double>() == Approx(times[time]));
      const double expected = (10 - 2) * (steps[run] - converged) * times[time] / 2;
      CHECK(at["median"].get<double>() == Approx(expected).margin(0.05));
      CHECK(at["ninetieth"] == at["median"]); /* the same in all worlds */
    }
}

TEST_CASE("command: bench controls --error falls with the step, of bodies that collide alone", "[command]")
{
  const Scratch scratch;
  const std::string robot = scratch.file("arm.xml");
  std::ofstream(robot) << R"(<mujoco><default><joint damping="0.2"/><geom type="capsule" size="0.05"/></default>
    <worldbody><body><joint name="turn" axis="0 0 1"/><joint name="lift" axis="0 1 0"/><geom fromto="0 0 0 0.4 0 0"/>
    <body pos="0.5 0 0"><joint name="bend" axis="0 1 0"/><geom fromto="0 0 0 0.3 0 0"/></body></body></worldbody>
    <actuator><motor joint="turn" gear="5" ctrlrange="-1 1"/><motor joint="bend" gear="2" ctrlrange="-1 1"/></actuator>
    </mujoco>)";
  const Json json = json_of("bench controls --n 4 --steps 1 --on serial --error --scene '" + robot + "'");
  const Json &error = json["robots"][0]["error"];
  CHECK(error["bodies"] == 2); /* not the copy of the first link between its two hinges */
  for (size_t time = 0; time < 4; ++time) {
    INFO(error.dump());
    const double full = median_distance(error, 0, time), half = median_distance(error, 1, time);
    CHECK(full > 0.1);
    CHECK(half < 0.7 * full);
    CHECK(half > 0.3 * full); /* first order */
    CHECK(median_distance(error, 2, time) < 0.1 * full);
  }
}

TEST_CASE("command: bench controls --error refuses robots of which nothing collides", "[command]")
{
  const Scratch scratch;
  const std::string robot = scratch.file("ghost.xml");
  std::ofstream(robot) << R"(<mujoco><worldbody><body><joint name="turn"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>
    <actuator><motor joint="turn" ctrlrange="-1 1"/></actuator></mujoco>)";
  check_refused("bench controls --n 1 --steps 1 --on serial --error --scene '" + robot + "'",
                "no body that moves collides");
  check_refused("bench worlds --error", "--error is of bench controls; bench worlds has none, leave it out");
}

TEST_CASE("command: bench controls refuses what it cannot do", "[command]")
{
  check_refused("bench controls --scene box-stack:n=2 --on serial", "no hinge or slider has damping");
  check_refused("bench controls --scene none.xml --on serial", "none.xml");
  check_refused("bench controls --n 0", "--n '0'");
  check_refused("bench controls --steps 0", "--steps '0'");
  check_refused("bench controls --on abacus", "abacus");
  check_refused("bench controls --table-in page.md", "--table-in is of bench scenes");
}
#endif
