/* bodies.cpp - times creation, destruction and reads of bodies; see bodies.h. */
#include "tools/bench/bodies.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr int body_repetitions = 7, read_repetitions = 101;

/* Calls are collected until something is read, so the time of a call ends with a read. */
template <class Work> double time_until_applied(World &world, const Work &work)
{
  world.finish();
  const auto start = std::chrono::steady_clock::now();
  work();
  world.read_body(world.id_of(1));
  world.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Body box_at_place(uint64_t place, uint64_t side)
{
  Body body;
  body.shape = 1;
  body.position = {1.5 * static_cast<double>(place % side), 0.5, 1.5 * static_cast<double>(place / side)};
  return body;
}

/* The floor, and the box that is read. */
Scene floor_and_box()
{
  Scene scene;
  scene.name = "a floor and a box";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies = {Body{}, box_at_place(0, 1)};
  scene.bodies[0].type = BodyType::fixed;
  scene.bodies[1].position[0] = -5;
  return scene;
}

std::vector<Body> new_boxes(uint64_t count)
{
  const auto side = static_cast<uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<Body> bodies;
  for (uint64_t k = 0; k < count; ++k) bodies.push_back(box_at_place(k, side));
  return bodies;
}

} // namespace

BodyTimes bench_bodies(const std::string &backend, uint64_t bodies, bool allow_inexact)
{
  BodyTimes times;
  times.bodies = bodies;
  World world(floor_and_box(), {}, {backend, {}, allow_inexact});
  world.step(); /* the first step compiles */
  const std::vector<Body> wanted = new_boxes(bodies);
  std::vector<double> create, destroy, singly, step, read;
  std::vector<BodyId> ids;
  const auto destroy_all = [&] {
    destroy.push_back(time_until_applied(world, [&] { world.destroy_bodies(ids); }));
    world.step(); /* frees their indices */
  };
  times.grow = time_until_applied(world, [&] { ids = world.create_bodies(wanted); });
  for (int k = 0; k < body_repetitions; ++k) {
    world.step();
    destroy_all();
    create.push_back(time_until_applied(world, [&] { ids = world.create_bodies(wanted); }));
    step.push_back(time_until_applied(world, [&] { world.step(); }));
    destroy_all();
    singly.push_back(time_until_applied(world, [&] {
      for (size_t body = 0; body < wanted.size(); ++body) ids[body] = world.create_body(wanted[body]);
    }));
  }
  for (int k = 0; k < read_repetitions; ++k) read.push_back(time_until_applied(world, [] {}));
  times.create = spread_of(create);
  times.destroy = spread_of(destroy);
  times.create_singly = spread_of(singly);
  times.step_after_create = spread_of(step);
  times.read = spread_of(read);
  return times;
}

std::string bodies_text(const std::vector<BodyTimes> &times)
{
  Table table(
      {"bodies", "first create, ms", "create, ms", "one by one, ms", "step after, ms", "destroy, ms", "read one, us"});
  for (const BodyTimes &row : times)
    table.add({fmt::format("{}", row.bodies), fmt::format("{:.3f}", row.grow), fmt::format("{:.3f}", row.create.median),
               fmt::format("{:.3f}", row.create_singly.median), fmt::format("{:.3f}", row.step_after_create.median),
               fmt::format("{:.3f}", row.destroy.median), fmt::format("{:.2f}", 1e3 * row.read.median)});
  return table.text("  ");
}

Json bodies_json(const std::vector<BodyTimes> &times)
{
  Json json = Json::array();
  for (const BodyTimes &row : times)
    json.push_back({{"bodies", row.bodies},
                    {"first_create_ms", row.grow},
                    {"create_ms", spread_json(row.create)},
                    {"create_singly_ms", spread_json(row.create_singly)},
                    {"step_after_create_ms", spread_json(row.step_after_create)},
                    {"destroy_ms", spread_json(row.destroy)},
                    {"read_ms", spread_json(row.read)}});
  return json;
}

int execute_bodies(const BenchOptions &options)
{
  std::vector<uint64_t> counts{1000, 10000};
  if (!options.count.empty()) counts = {whole_number("--n", options.count, 1, most_bodies)};
  options.json.check();
  std::vector<BodyTimes> times;
  for (const uint64_t count : counts) times.push_back(bench_bodies(options.on, count, options.inexact));
  if (!options.json.takes_standard_output())
    fmt::print("bodies on {}: medians, the wait for the device included\n{}", options.on, bodies_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"worlds", bodies_json(times)}});
  return 0;
}

} // namespace tandem
