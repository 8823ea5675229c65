/* worlds_command_test.cpp - `tandem run --worlds` and `tandem bench worlds`, run as a script would. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

TEST_CASE("command: a run of many worlds has the hash of a run of one", "[command]")
{
  const std::string pile = "run falling-boxes:n=6,height=0 --steps 30";
  const auto one = json_of(pile + " --on serial"), many = json_of(pile + " --on tbb --worlds 5");
  check_keys(many,
             {"scene", "backend", "worlds", "bodies_of_world", "steps", "step_ms", "stages", "world_steps_per_second",
              "pairs", "contacts", "nonfinite", "overflow", "launches", "hash", "equal_worlds"});
  CHECK(many["worlds"] == 5);
  CHECK(many["bodies_of_world"] == 7);
  CHECK(many["hash"] == one["hash"]);
  CHECK(many["equal_worlds"] == 5);
  CHECK(many["contacts"] == 5 * one["contacts"].get<int>());
}

TEST_CASE("command: what a run of many worlds refuses", "[command]")
{
  const Scratch scratch;
  check_refused("run spheres:n=3 --worlds 0", "--worlds");
  check_refused("run spheres:n=3 --worlds many", "--worlds");
  check_refused("run spheres:n=1000 --worlds 4000000", "kernels can number");
  check_refused("run spheres:n=3 --worlds 2 --sleep", "sleeping");
  check_refused("run spheres:n=3 --worlds 2 --solver pgs", "pgs");
  check_refused("run spheres:n=3 --worlds 2 --save " + scratch.file("a.glb"), "--save");
}

TEST_CASE("command: bench worlds has the promised keys", "[command]")
{
  const auto bench = json_of("bench worlds --n 3 --on serial");
  check_keys(bench, {"what", "backend", "batches"});
  REQUIRE(bench["batches"].size() == 2);
  for (const auto &batch : bench["batches"]) {
    check_keys(batch, {"scene", "worlds", "bodies_of_world", "step_ms", "world_steps_per_second", "launches",
                       "worlds_alone", "alone_ms"});
    CHECK(batch["worlds"] == 3);
    CHECK(batch["world_steps_per_second"].get<double>() > 0);
    CHECK(batch["alone_ms"].get<double>() > 0);
  }
  check_refused("bench worlds --n 0", "--n");
}
#endif
