/* diff_test.cpp - cases that `tandem diff` must report: an error that was planted nowhere, and bodies that were taken
 * out. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string spheres = "diff spheres:n=40 --steps 3 --between serial,tbb --plant ";

} // namespace

TEST_CASE("diff: an error that can be planted nowhere is bad use", "[command]")
{
  check_refused(spheres + "solve_contacts:solver_velocity:99999999:1",
                "nothing was planted in 3 steps: solver_velocity holds");
  check_refused(spheres + "solve_contacts:solver_velocity:0:99",
                "nothing was planted in 3 steps: solve_contacts does not run in step 99");
  check_refused(spheres + "collide_box_box:manifold_points:0",
                "nothing was planted in 3 steps: collide_box_box does not run in step 0");
  check_refused(spheres + "solve_contacts:bounds:0:1",
                "nothing was planted in 3 steps: solve_contacts does not write bounds");
  check_refused(spheres + "solve_contacts:solver_velocity:0:99 --json -", "nothing was planted");
}

TEST_CASE("diff: an error that was planted is found", "[command]")
{
  const Result found =
      command("diff spheres:n=40 --steps 3 --between serial,tbb --plant integrate_velocities:solver_velocity:25:2");
  CHECK(found.status == 1);
  CHECK(found.out.find("DIFFERENT: serial and tbb in step 2, kernel integrate_velocities") == 0);
}

TEST_CASE("diff: bodies that were taken out alike are equal, and said", "[command]")
{
  const Scratch folder;
  std::ofstream(folder.file("fly.json"))
      << R"({"tandem_scene":1,"shapes":[{"type":"sphere","radius":0.5}],"bodies":[{"name":"fly",)"
         R"("linear_velocity":[3e38,0,0]},{"position":[5,0,0]}]})";
  const Result result = command("diff " + folder.file("fly.json") + " --dt 10 --steps 60");
  CAPTURE(result.out, result.error);
  CHECK(result.status == 0);
  CHECK(result.out.find("EQUAL") == 0);
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
  CHECK(result.error.find("tandem: 1 of ") == 0);
  CHECK(result.error.find("'fly'") != std::string::npos);
  CHECK(json_of("diff " + folder.file("fly.json") + " --dt 10 --steps 60")["quarantined"] == 1);
  CHECK(command("diff spheres:n=4 --steps 3").error.empty());
}
#endif
