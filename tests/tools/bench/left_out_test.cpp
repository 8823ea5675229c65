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

const std::string few_boxes = "box-grid:nx=2,ny=2,nz=2", mesh_slide = "mesh-slide", few_balls = "spheres:n=4";

ScenesRequest left_out_request(const std::vector<std::string> &scenes)
{
  ScenesRequest request;
  request.scenes = scenes;
  request.steps = 2;
  request.placement = {"tbb:threads=1,lanes=4", {}, false};
  return request;
}

const LeftOut *left_out_row(const std::vector<LeftOut> &rows, const std::string &scene, const std::string &feature)
{
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const LeftOut &row) { return row.scene == scene && row.feature == feature; });
  return found == rows.end() ? nullptr : &*found;
}

} // namespace

TEST_CASE("bench left-out: a scene has a row for each feature that it lacks, and no other")
{
  const std::vector<LeftOut> rows = bench_left_out(left_out_request({few_boxes, mesh_slide, few_balls}));
  for (const LeftOut &row : rows) {
    CAPTURE(row.scene, row.feature);
    CHECK(row.failure.empty());
    CHECK(row.with.kernels >= row.without.kernels);
    CHECK(row.with.bytes >= row.without.bytes);
    CHECK(row.without.milliseconds.minimum > 0);
  }
  CHECK(failures_of(rows).empty());
  CHECK(left_out_row(rows, few_boxes, "FRICTION") == nullptr);
  CHECK(left_out_row(rows, few_boxes, "BOX_BOX") == nullptr);
  CHECK(left_out_row(rows, few_balls, "BOX_BOX") != nullptr);
  CHECK(left_out_row(rows, mesh_slide, "TREES") == nullptr);
  const std::vector<std::string> all = scene_feature_names();
  const auto of_boxes =
      std::count_if(rows.begin(), rows.end(), [](const LeftOut &row) { return row.scene == few_boxes; });
  const auto had = std::count_if(
      all.begin(), all.end(), [&](const std::string &name) { return left_out_row(rows, few_boxes, name) == nullptr; });
  CHECK(of_boxes + had == static_cast<std::ptrdiff_t>(all.size()));
}

TEST_CASE("bench left-out: rows of friction and of points beyond the first are bytes of pairs, damping of bodies")
{
  const std::vector<LeftOut> rows = bench_left_out(left_out_request({mesh_slide, few_balls}));
  const LeftOut *friction = left_out_row(rows, mesh_slide, "FRICTION"),
                *points = left_out_row(rows, few_balls, "SEVERAL_POINTS"),
                *damping = left_out_row(rows, few_balls, "DAMPING");
  REQUIRE(friction != nullptr);
  REQUIRE(points != nullptr);
  REQUIRE(damping != nullptr);
  World world(load_scene(mesh_slide), {}, left_out_request({}).placement);
  for (uint64_t k = 0; k < scene_warm_steps + 2; ++k) world.step();
  const uint64_t pairs = world.memory().bytes(Buffer::constraint_normal_impulse) / 16;
  CHECK(friction->without.bytes == world.memory().total_bytes());
  /* Of the three rows of 16 bytes, the one that the commit writes has the arms in its memory until then. */
  CHECK(friction->with.bytes - friction->without.bytes == 32 * pairs);
  CHECK(points->with.bytes > points->without.bytes);
  CHECK(damping->with.bytes - damping->without.bytes == 8 * load_scene(few_balls).bodies.size());
  CHECK(damping->with.launches.median == damping->without.launches.median);
}

TEST_CASE("bench left-out: a row that fails says so, and stops no other")
{
  ScenesRequest request = left_out_request({few_boxes, "free-flight:n=3"});
  request.settings.max_pairs = 1;
  const std::vector<LeftOut> rows = bench_left_out(request);
  CHECK(!rows.front().failure.empty());
  CHECK(rows.back().failure.empty());
  CHECK(failures_of(rows).front().find(few_boxes + " with " + rows.front().feature + " failed: ") == 0);
  CHECK(left_out_markdown(rows).find("| " + rows.front().feature + " | failed | - |") != std::string::npos);
  CHECK(left_out_json(rows)[0].contains("failure"));
}

TEST_CASE("bench left-out: rows of the page have a cell for each column")
{
  const std::vector<LeftOut> rows = bench_left_out(left_out_request({"free-flight:n=3"}));
  const std::string page = left_out_markdown(rows);
  CHECK(std::count(page.begin(), page.end(), '\n') == static_cast<std::ptrdiff_t>(2 + rows.size()));
  CHECK(std::count(page.begin(), page.end(), '|') == static_cast<std::ptrdiff_t>(11 * (2 + rows.size())));
}

#endif
