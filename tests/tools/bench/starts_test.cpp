/* starts_test.cpp - `tandem bench starts` tells which starts end in other bits. */
#ifdef TANDEM_COMMAND
#include "tests/catch.h"
#include "tools/bench/starts.h"

using namespace tandem;

namespace {

StartTime start_with_hash(const std::string &scene, bool cached, const std::string &hash)
{
  StartTime time;
  time.scene = scene;
  time.cached = cached;
  time.hash = hash;
  return time;
}

} // namespace

TEST_CASE("bench starts: starts of one scene are compared, and those of another are not")
{
  std::vector<StartTime> starts = {start_with_hash("spheres", false, "a"), start_with_hash("spheres", true, "a"),
                                   start_with_hash("arch", false, "b"), start_with_hash("arch", true, "b")};
  CHECK(differences_of(starts).empty());
  starts[3].hash = "a";
  const std::vector<std::string> lines = differences_of(starts);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "arch: after the first step the start on the device with caches filled has the hash a, that on the "
                    "device with caches off has b");
}
#endif
