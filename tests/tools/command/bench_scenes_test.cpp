/* bench_scenes_test.cpp - the real program: `tandem bench scenes` fills a page, and refuses bad use in one line. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

TEST_CASE("command: bench scenes has the promised keys and writes its table into a page", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), before = "text\n<!-- table serial: begin -->\n",
                    after = "<!-- table serial: end -->\nmore\n";
  std::ofstream(page) << before << after;
  const std::string arguments = "bench scenes --scene free-flight,thin-wall --steps 3 --on serial --table-in " + page;
  const Json json = json_of(arguments);
  check_keys(json, {"what", "backend", "steps", "kernels", "scenes"});
  CHECK(json["steps"] == 3);
  REQUIRE(json["scenes"].size() == 3);
  for (const Json &scene : json["scenes"]) {
    check_keys(scene, {"scene", "all_features", "moving_bodies", "kernels_built", "launches", "memory_bytes",
                       "build_ms", "step_ms", "pairs", "contacts"});
    CHECK(scene["step_ms"]["min"].get<double>() > 0);
    CHECK(scene["kernels_built"] <= json["kernels"]);
  }
  const std::string written = contents(page);
  CHECK(written.find(before + "```\ntandem bench scenes --on serial --scene free-flight,thin-wall --steps 3") == 0);
  CHECK(written.find("\n| thin-wall | ") != std::string::npos);
  CHECK(written.find(after) == written.size() - after.size());
}

TEST_CASE("command: bench scenes refuses what it cannot do", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), small = "bench scenes --scene free-flight --on serial ";
  std::ofstream(page) << "<!-- table tbb: begin -->\n<!-- table tbb: end -->\n";
  check_refused("bench scenes --scene nonsense", "--scene 'nonsense': no built-in scene has this name; use box-grid, ");
  check_refused("bench scenes --scene free-flight,pile --on serial", "'pile'");
  check_refused(small + "--table-in " + page, "'<!-- table serial: begin -->' and '<!-- table serial: end -->'");
  CHECK(contents(page) == "<!-- table tbb: begin -->\n<!-- table tbb: end -->\n");
  check_refused(small + "--table-in " + scratch.file("none.md"), "none.md");
  check_refused(small + "--steps 0", "--steps '0'");
  check_refused(small + "--n 100", "--n");
  check_refused("bench scenes --on abacus", "abacus");
  check_refused("bench step --steps 5", "--steps is of bench scenes");
  check_refused("bench sleeping --table-in " + page, "--table-in is of bench scenes");
}

TEST_CASE("command: bench floors fills a page, and refuses what it cannot do", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), small = "bench floors --scene spheres:n=4,height=0 --on serial ";
  std::ofstream(page) << "<!-- table floors serial: begin -->\n<!-- table floors serial: end -->\n";
  const Json json = json_of(small + "--table-in " + page);
  CHECK(json["what"] == "floors");
  CHECK(contents(page).find("tandem bench floors --on serial --scene spheres:n=4,height=0") != std::string::npos);
  check_refused(small + "--n 100", "--n: bench floors takes the size from --scene");
  check_refused("bench floors --scene castle", "unknown scene 'castle'");
  check_refused("bench floors --scene spheres:n=0", "n=");
  check_refused("bench floors --on tbb --table-in " + page, "'<!-- table floors tbb: begin -->'");
  check_refused("bench floors --on abacus", "abacus");
}
#endif
