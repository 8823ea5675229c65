/* bench_left_out_test.cpp - the real program: `tandem bench left-out` fills a page, and refuses bad use in one line. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

TEST_CASE("command: bench left-out has the promised keys and writes its table into a page", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), before = "text\n<!-- table left-out serial: begin -->\n",
                    after = "<!-- table left-out serial: end -->\nmore\n";
  std::ofstream(page) << before << after;
  const Json json = json_of("bench left-out --scene free-flight --steps 3 --on serial --table-in " + page);
  check_keys(json, {"what", "backend", "steps", "features", "rows"});
  CHECK(json["steps"] == 3);
  REQUIRE(!json["rows"].empty());
  for (const Json &row : json["rows"]) {
    check_keys(row, {"scene", "feature", "without", "with"});
    for (const char *side : {"without", "with"})
      check_keys(row[side], {"kernels_built", "launches", "memory_bytes", "step_ms"});
  }
  const std::string written = contents(page);
  CHECK(written.find(before + "```\ntandem bench left-out --on serial --scene free-flight --steps 3") == 0);
  CHECK(written.find("\n| free-flight | RESTITUTION | ") != std::string::npos);
  CHECK(written.find(after) == written.size() - after.size());
}

TEST_CASE("command: bench left-out refuses what it cannot do", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), small = "bench left-out --scene free-flight --on serial ";
  std::ofstream(page) << "<!-- table serial: begin -->\n<!-- table serial: end -->\n";
  check_refused("bench left-out --scene nonsense", "--scene 'nonsense': no built-in scene has this name; use ");
  check_refused(small + "--table-in " + page, "'<!-- table left-out serial: begin -->'");
  check_refused(small + "--steps 0", "--steps '0'");
  check_refused(small + "--n 100", "--n: the scenes of bench left-out");
  check_refused("bench left-out --on abacus", "abacus");
}
#endif
