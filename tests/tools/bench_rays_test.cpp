/* `tandem bench rays`: blocked rays are those that hit something, and few rays give the hits that the boxes' density foretells. */
#include "tests/catch.h"

#include "tools/bench_rays.h"

using namespace tandem;

TEST_CASE("bench rays times the hierarchy and two queries that agree on what is hit")
{
  const std::vector<RayTime> times = bench_rays("tbb:threads=2", 2000, 3000, false);
  REQUIRE(times.size() == 3);
  CHECK(times[1].hits == times[2].hits);
  CHECK((times[1].hits > 1500 && times[1].hits < 3000)); /* a tenth is filled, 27 boxes deep */
  for (const RayTime &time : times) CHECK(time.milliseconds.median > 0);
  const Json json = rays_json(times, 3000);
  CHECK(json[0]["what"] == "hierarchy");
  CHECK(json[1]["rays"] == 3000);
  CHECK(json[2]["ms"]["min"] <= json[2]["ms"]["median"]);
  CHECK(rays_text(times, 3000).find("nearest") != std::string::npos);
}
