/* scenes_test.cpp - `tandem bench scenes`: a scene takes less than the same with all features, the counts are those of
 * the world, and a scene that fails stops no other. */
#ifdef TANDEM_COMMAND
#include <algorithm>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tools/bench/scenes.h"

using namespace tandem;

namespace {

const std::string boxes = "box-grid:nx=2,ny=2,nz=2", flight = "free-flight:n=3";

ScenesRequest request_of(const std::vector<std::string> &scenes)
{
  ScenesRequest request;
  request.scenes = scenes;
  request.steps = 2;
  request.placement = {"tbb:threads=1,lanes=4", {}, false};
  return request;
}

} // namespace

TEST_CASE("bench scenes: a scene takes less than the same with all features, and meets the same bodies")
{
  const std::vector<SceneCost> costs = bench_scenes(request_of({boxes, flight}));
  REQUIRE(costs.size() == 3);
  const SceneCost &grid = costs[0], &free = costs[1], &all = costs[2];
  CHECK(grid.moving == 8);
  CHECK(free.moving == 3);
  CHECK(grid.contacts > 0);
  CHECK(free.contacts == 0);
  CHECK(free.launches.median < grid.launches.median);
  CHECK(free.bytes < grid.bytes);
  CHECK(all.scene == boxes);
  CHECK(!all.specialised);
  CHECK(all.kernels > grid.kernels);
  CHECK(all.launches.median > grid.launches.median);
  CHECK(all.bytes > grid.bytes);
  CHECK(all.pairs == grid.pairs);
  CHECK(all.contacts == grid.contacts);
}

TEST_CASE("bench scenes: the counts are those of a world that made as many steps")
{
  const ScenesRequest request = request_of({boxes});
  const SceneCost cost = bench_scenes(request).front();
  World world(load_scene(boxes), request.settings, request.placement);
  uint64_t most = 0, least = UINT64_MAX;
  for (uint64_t k = 0; k < scene_warm_steps + request.steps; ++k) {
    const uint64_t before = world.launches();
    world.step();
    if (k < scene_warm_steps) continue;
    most = std::max(most, world.launches() - before);
    least = std::min(least, world.launches() - before);
  }
  CHECK(cost.launches.maximum == static_cast<double>(most));
  CHECK(cost.launches.minimum == static_cast<double>(least));
  CHECK(cost.kernels == world.kernels().size());
  CHECK(cost.bytes == world.memory().total_bytes());
  CHECK(cost.pairs == world.statistics().pairs);
  CHECK(cost.contacts == world.statistics().contacts);
}

TEST_CASE("bench scenes: a scene that fails is named, and the others have their rows")
{
  ScenesRequest request = request_of({boxes, flight});
  request.settings.max_pairs = 1;
  const std::vector<SceneCost> costs = bench_scenes(request);
  REQUIRE(costs.size() == 3);
  CHECK(!costs[0].failure.empty());
  CHECK(costs[1].failure.empty());
  const std::vector<std::string> failures = failures_of(costs);
  REQUIRE(failures.size() == 2);
  CHECK(failures[0].find(boxes + " failed: ") == 0);
  CHECK(failures[1].find(boxes + ", all features failed: ") == 0);
  CHECK(scenes_markdown(costs).find("| " + boxes + " | failed | - |") != std::string::npos);
  const Json json = scenes_json(costs);
  CHECK(json[0]["failure"] == costs[0].failure);
  CHECK(!json[1].contains("failure"));
}

TEST_CASE("bench scenes: a request that is wrong fails as a whole")
{
  ScenesRequest request = request_of({boxes});
  request.placement.on = "abacus";
  CHECK_THROWS_AS(bench_scenes(request), InputError);
  CHECK_THROWS_AS(scene_names({"spheres", "castle"}), InputError);
  CHECK(scene_names({"spheres"}) == std::vector<std::string>{"spheres"});
  CHECK(scene_names({}).size() == built_in_scenes().size());
}

TEST_CASE("bench scenes: rows of the page have a cell for each column")
{
  const std::string page = scenes_markdown(bench_scenes(request_of({flight})));
  const size_t bars = static_cast<size_t>(std::count(page.begin(), page.end(), '|'));
  CHECK(std::count(page.begin(), page.end(), '\n') == 4); /* header, rule, the scene, all features */
  CHECK(bars == 4 * 11);
  CHECK(page.find("\n| " + flight + ", all features | 3 | ") != std::string::npos);
}

#endif
