/* left_out_test.cpp - `tandem bench left-out`: a row for each feature that a scene lacks, whose counts are those of the
 * two worlds. */
#ifdef TANDEM_COMMAND
#include <algorithm>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tools/bench/left_out.h"

using namespace tandem;

namespace {

const std::string boxes = "box-grid:nx=2,ny=2,nz=2", slide = "mesh-slide", balls = "spheres:n=4";

ScenesRequest request_of(const std::vector<std::string> &scenes)
{
  ScenesRequest request;
  request.scenes = scenes;
  request.steps = 2;
  request.placement = {"tbb:threads=1,lanes=4", {}, false};
  return request;
}

const LeftOut *row_of(const std::vector<LeftOut> &rows, const std::string &scene, const std::string &feature)
{
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const LeftOut &row) { return row.scene == scene && row.feature == feature; });
  return found == rows.end() ? nullptr : &*found;
}

} // namespace

TEST_CASE("bench left-out: a scene has a row for each feature that it lacks, and no other")
{
  const std::vector<LeftOut> rows = bench_left_out(request_of({boxes, slide, balls}));
  for (const LeftOut &row : rows) {
    CAPTURE(row.scene, row.feature);
    CHECK(row.failure.empty());
    CHECK(row.with.kernels >= row.without.kernels);
    CHECK(row.with.bytes >= row.without.bytes);
    CHECK(row.without.milliseconds.minimum > 0);
  }
  CHECK(failures_of(rows).empty());
  CHECK(row_of(rows, boxes, "FRICTION") == nullptr);
  CHECK(row_of(rows, boxes, "BOX_BOX") == nullptr);
  CHECK(row_of(rows, balls, "BOX_BOX") != nullptr);
  CHECK(row_of(rows, slide, "TREES") == nullptr);
  const World world(load_scene(boxes));
  const std::vector<std::string> all = scene_feature_names();
  const auto of_boxes = std::count_if(rows.begin(), rows.end(), [](const LeftOut &row) { return row.scene == boxes; });
  const auto had = std::count_if(all.begin(), all.end(),
                                 [&](const std::string &name) { return row_of(rows, boxes, name) == nullptr; });
  CHECK(of_boxes + had == static_cast<std::ptrdiff_t>(all.size()));
}

TEST_CASE("bench left-out: rows of friction and of points beyond the first are bytes of pairs, damping is none")
{
  const std::vector<LeftOut> rows = bench_left_out(request_of({slide, balls}));
  const LeftOut *friction = row_of(rows, slide, "FRICTION"), *points = row_of(rows, balls, "SEVERAL_POINTS"),
                *damping = row_of(rows, balls, "DAMPING");
  REQUIRE(friction != nullptr);
  REQUIRE(points != nullptr);
  REQUIRE(damping != nullptr);
  World world(load_scene(slide), {}, request_of({}).placement);
  for (uint64_t k = 0; k < scene_warm_steps + 2; ++k) world.step();
  const uint64_t pairs = world.memory().bytes(Buffer::constraint_normal_impulse) / 16;
  CHECK(friction->without.bytes == world.memory().total_bytes());
  CHECK(friction->with.bytes - friction->without.bytes == 48 * pairs);
  CHECK(points->with.bytes > points->without.bytes);
  CHECK(damping->with.bytes == damping->without.bytes);
  CHECK(damping->with.launches.median == damping->without.launches.median);
}

TEST_CASE("bench left-out: a row that fails says so, and stops no other")
{
  ScenesRequest request = request_of({boxes, "free-flight:n=3"});
  request.settings.max_pairs = 1;
  const std::vector<LeftOut> rows = bench_left_out(request);
  CHECK(!rows.front().failure.empty());
  CHECK(rows.back().failure.empty());
  CHECK(failures_of(rows).front().find(boxes + " with " + rows.front().feature + " failed: ") == 0);
  CHECK(left_out_markdown(rows).find("| " + rows.front().feature + " | failed | - |") != std::string::npos);
  CHECK(left_out_json(rows)[0].contains("failure"));
}

TEST_CASE("bench left-out: rows of the page have a cell for each column")
{
  const std::vector<LeftOut> rows = bench_left_out(request_of({"free-flight:n=3"}));
  const std::string page = left_out_markdown(rows);
  CHECK(std::count(page.begin(), page.end(), '\n') == static_cast<std::ptrdiff_t>(2 + rows.size()));
  CHECK(std::count(page.begin(), page.end(), '|') == static_cast<std::ptrdiff_t>(11 * (2 + rows.size())));
}

#endif
