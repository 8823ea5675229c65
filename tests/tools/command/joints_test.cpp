/* joints_test.cpp - scenes with joints by the real program: what it reports, that devices agree, and what it
 * refuses. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

/* The path of a scene of three bodies with a good joint and this one. */
std::string file_with_joint(const Scratch &folder, const std::string &joint)
{
  const std::string path = folder.file("leg.json");
  std::ofstream(path) << R"({"tandem_scene":1,"shapes":[{"type":"sphere","radius":0.5}],"bodies":[{},)"
                      << R"({"position":[1,0,0]},{"motion":"fixed","position":[2,0,0]}],"joints":[{"body_a":0},)"
                      << joint << "]}";
  return path;
}

} // namespace

TEST_CASE("command: joints that cannot be simulated are refused by one line", "[command]")
{
  const Scratch folder;
  const std::pair<const char *, const char *> cases[] = {
      {R"({"body_a":0,"body_b":1,"type":"glue"})", "glue"},
      {R"({"body_a":0,"body_b":3})", "joint 1: body_b 3 does not exist; the scene has 3 bodies"},
      {R"({"type":"ball"})", "joint 1: it connects the world with itself"},
      {R"({"body_b":2})", "joint 1: neither of its bodies is dynamic"},
      {R"({"body_a":1,"position_a":["nan",0,0]})", "position_a"},
      {R"({"body_a":1,"orientation_a":[0,0,0,3]})", "joint 1: orientation_a is [0, 0, 0, 3]"},
  };
  for (const auto &[joint, mentions] : cases)
    check_refused("run '" + file_with_joint(folder, joint) + "' --steps 1 --on serial", mentions);
}

TEST_CASE("command: what has no couplings refuses them by one line", "[command]")
{
  check_refused("run crane --steps 1 --on serial --solver avbd",
                "the solver avbd has no couplings, of which the scene has 1; soft-step, pgs, nncg, xpbd, "
                "jacobi, direct have them");
}

TEST_CASE("command: a run reports its joints, and devices agree on them", "[command]")
{
  const command_line::Json result = json_of("run joint-grid:columns=5,rows=4 --steps 20 --on serial");
  CHECK(result["joints"] == 5 * 3 + 4 * 3);
  CHECK(result["joint_error"]["max"] > 0);
  CHECK(result["joint_error"]["max"] < 0.01);
  CHECK(result["joint_error"]["mean"] <= result["joint_error"]["max"]);
  CHECK(result["joint_error"]["max_angle"] == 0);
  for (const char *scene : {"joint-grid:columns=5,rows=4", "hinge-chain:n=6", "pendulums:n=4",
                            "newton-cradle:n=3,length=0.5", "four-bar", "vehicle"}) {
    const Result diff = command(std::string("diff ") + scene + " --steps 10 --between serial,tbb");
    CAPTURE(scene, diff.out, diff.error);
    CHECK(diff.status == 0);
    CHECK(diff.out.find("EQUAL") == 0);
  }
  CHECK(json_of("run pendulums:n=4 --steps 5 --on serial")["hash"] ==
        json_of("run pendulums:n=4 --steps 5 --on tbb")["hash"]);
}

TEST_CASE("command: an error that is planted in a joint is found at its kernel", "[command]")
{
  const Result found = command("diff hinge-chain:n=6 --steps 3 --between serial,tbb --plant "
                               "solve_joints:joint_linear_impulse:1:1");
  CAPTURE(found.out, found.error);
  CHECK(found.status == 1);
  CHECK(found.out.find("DIFFERENT: serial and tbb in step 1, kernel solve_joints") == 0);
}
#endif
