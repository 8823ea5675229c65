/* rays.cpp - times ray queries against a cube of boxes; see rays.h. */
#include "tools/bench/rays.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/interface/kernel_list.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr int repetitions = 7;

Scene boxes_in_a_cube(uint32_t boxes, double side)
{
  Random random(31);
  Scene scene;
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies.resize(boxes);
  for (Body &body : scene.bodies) {
    body.type = BodyType::fixed;
    body.position = {random.uniform(0, side), random.uniform(0, side), random.uniform(0, side)};
    body.orientation = random.orientation();
  }
  return scene;
}

/* Rays from one side of the cube to another, in random order. */
std::vector<Ray> rays_through_a_cube(uint32_t count, double side)
{
  Random random(32);
  const auto place = [&] {
    Point p{random.uniform(0, side), random.uniform(0, side), random.uniform(0, side)};
    p[random.below(3)] = random.below(2) ? -1 : side + 1;
    return p;
  };
  std::vector<Ray> rays(count);
  for (Ray &ray : rays) {
    ray.origin = place();
    const Point to = place();
    for (size_t axis = 0; axis < 3; ++axis)
      ray.direction[axis] = static_cast<float>(to[axis] - ray.origin[axis] + 1e-3);
  }
  return rays;
}

/* The time of kernels since the last call: of the query, and of all others, which make the structure. */
std::pair<double, double> spent(World &world, Kernel query)
{
  double own = 0, others = 0;
  for (const KernelTime &time : world.take_kernel_times()) (time.kernel == query ? own : others) += time.milliseconds;
  return {own, others};
}

/* Setting a body to its own state causes the structure to be rebuilt. */
void touch(World &world)
{
  world.set_body(0, world.bodies().front());
  world.take_kernel_times();
}

/* Times the queries with one broadphase's structure. */
std::vector<RayTime> time_rays(World &world, const std::string &structure, const std::vector<Ray> &asked)
{
  RayTime nearest{structure, "nearest"}, blocked{structure, "blocked"}, making{structure, "making"};
  std::vector<double> near, block, make;
  world.cast_rays(asked); /* builds the kernels */
  world.cast_rays_any(asked);
  world.set_profiling(true);
  for (int k = 0; k < repetitions; ++k) {
    touch(world);
    const std::vector<RayHit> hits = world.cast_rays(asked);
    const auto [own, others] = spent(world, Kernel::cast_rays);
    near.push_back(own);
    make.push_back(others);
    nearest.hits = static_cast<uint64_t>(
        std::count_if(hits.begin(), hits.end(), [](const RayHit &hit) { return hit.body != no_body; }));
    const std::vector<bool> found = world.cast_rays_any(asked);
    block.push_back(spent(world, Kernel::cast_rays_any).first);
    blocked.hits = static_cast<uint64_t>(std::count(found.begin(), found.end(), true));
  }
  nearest.milliseconds = spread_of(near);
  blocked.milliseconds = spread_of(block);
  making.milliseconds = spread_of(make);
  return {making, nearest, blocked};
}

constexpr uint32_t boxes_for_rays = 100000;

} // namespace

std::vector<RayTime> bench_rays(const std::string &backend, uint32_t boxes, uint32_t rays, bool allow_inexact)
{
  const double side = std::cbrt(10.0 * boxes);
  const std::vector<Ray> asked = rays_through_a_cube(rays, side);
  std::vector<RayTime> times;
  for (const auto &[structure, broadphase] : {std::pair{"hierarchy", Broadphase::bvh}, {"grid", Broadphase::grid}}) {
    Settings settings;
    settings.broadphase = broadphase;
    World world(boxes_in_a_cube(boxes, side), settings, {backend, {}, allow_inexact});
    const std::vector<RayTime> own = time_rays(world, structure, asked);
    times.insert(times.end(), own.begin(), own.end());
  }
  return times;
}

std::string rays_text(const std::vector<RayTime> &times, uint32_t rays)
{
  Table table({"structure", "what", "ms", "least", "most", "million rays/s", "hits"});
  for (const RayTime &time : times) {
    const bool query = time.what != "making";
    table.add({time.structure, time.what, fmt::format("{:.3f}", time.milliseconds.median),
               fmt::format("{:.3f}", time.milliseconds.minimum), fmt::format("{:.3f}", time.milliseconds.maximum),
               query ? fmt::format("{:.4g}", rays / time.milliseconds.median * 1e-3) : "",
               query ? fmt::format("{}", time.hits) : ""});
  }
  return table.text("  ");
}

Json rays_json(const std::vector<RayTime> &times, uint32_t rays)
{
  Json list = Json::array();
  for (const RayTime &time : times)
    list.push_back({{"structure", time.structure},
                    {"what", time.what},
                    {"rays", time.what == "making" ? 0 : rays},
                    {"hits", time.hits},
                    {"ms",
                     {{"median", time.milliseconds.median},
                      {"min", time.milliseconds.minimum},
                      {"max", time.milliseconds.maximum}}}});
  return list;
}

int execute_rays(const BenchOptions &options)
{
  const auto rays =
      static_cast<uint32_t>(options.count.empty() ? 1000000 : whole_number("--n", options.count, 1, uint64_t{1} << 26));
  options.json.check();
  const std::vector<RayTime> times = bench_rays(options.on, boxes_for_rays, rays, options.inexact);
  if (!options.json.takes_standard_output())
    fmt::print("rays on {}: {} rays, {} boxes\n{}", options.on, rays, boxes_for_rays, rays_text(times, rays));
  options.json.write({{"what", options.what},
                      {"backend", options.on},
                      {"n", rays},
                      {"boxes", boxes_for_rays},
                      {"times", rays_json(times, rays)}});
  return 0;
}

} // namespace tandem
