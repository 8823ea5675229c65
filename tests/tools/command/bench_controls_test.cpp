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
