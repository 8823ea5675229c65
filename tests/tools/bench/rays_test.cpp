/* `tandem bench rays`: blocked rays are those that hit something, and the number of hits of few rays agrees with the
 * density of the boxes. */
#include "tests/catch.h"
#include "tools/bench/rays.h"

using namespace tandem;

TEST_CASE("bench rays times two structures and two queries that agree on what is hit")
{
  const std::vector<RayTime> times = bench_rays("tbb:threads=2", 2000, 3000, false);
  REQUIRE(times.size() == 6);
  for (const size_t k : {2, 4, 5}) CHECK(times[1].hits == times[k].hits);
  CHECK((times[1].hits > 1500 && times[1].hits < 3000)); /* a tenth is filled, 27 boxes deep */
  for (const RayTime &time : times) CHECK(time.milliseconds.median > 0);
  const Json json = rays_json(times, 3000);
  CHECK(json[0]["structure"] == "hierarchy");
  CHECK(json[0]["what"] == "making");
  CHECK(json[3]["structure"] == "grid");
  CHECK(json[1]["rays"] == 3000);
  CHECK(json[2]["ms"]["min"] <= json[2]["ms"]["median"]);
  CHECK(rays_text(times, 3000).find("nearest") != std::string::npos);
}
