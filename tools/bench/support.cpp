/* support.cpp - times the support functions on random directions and compares their results; see support.h. */
#include "tools/bench/support.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/builders.h"
#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/memory.h"
#include "shared/narrowphase/hull_support.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr int repetitions = 5; /* the shortest time counts */

/* The hull of an ellipsoid of 1 x 0.75 x 0.5 m. */
Shape ellipsoid(uint32_t vertices)
{
  Random random(vertices);
  std::vector<Vec3> points;
  while (points.size() < vertices) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1),
                 length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length < 1)
      points.push_back({float(x / length), float(0.75 * y / length), float(0.5 * z / length)});
  }
  return hull_shape(points, "ellipsoid");
}

/* The tables of a shape as a world stores them. */
class Tables {
public:
  Tables(const Shape &shape, uint32_t cells)
      : world_(scene_of(shape), settings_of(cells), Placement{"serial", {}, false})
  {}
  hull_tables of(uint32_t support) const
  {
    return {headers_.data(), vertices_.data(), planes_.data(), starts_.data(), corners_.data(), edges_.data(),
            chunks_.data(),  links_.data(),    nullptr,        nullptr,        support};
  }

private:
  static Scene scene_of(const Shape &shape)
  {
    Scene scene;
    scene.shapes = {shape};
    scene_builders::add_body(scene, 0, {0, 0, 0}).inertia = {1, 1, 1};
    return scene;
  }
  static Settings settings_of(uint32_t cells)
  {
    Settings settings;
    settings.support = Support::hill_climbing;
    settings.support_cells = cells;
    return settings;
  }
  template <class T> std::vector<T> all(Buffer buffer)
  {
    return world_.memory().read<T>(buffer, world_.memory().bytes(buffer) / sizeof(T));
  }

  World world_;
  std::vector<float4> vertices_ = all<float4>(Buffer::hull_vertex), planes_ = all<float4>(Buffer::hull_plane),
                      chunks_ = all<float4>(Buffer::hull_chunk);
  std::vector<uint32_t> headers_ = all<uint32_t>(Buffer::hull_header), starts_ = all<uint32_t>(Buffer::hull_face_start);
  std::vector<uint32_t> corners_ = all<uint32_t>(Buffer::hull_corner), edges_ = all<uint32_t>(Buffer::hull_edge),
                        links_ = all<uint32_t>(Buffer::hull_link);
};

std::vector<vec3> directions_of(uint64_t many)
{
  Random random(7);
  std::vector<vec3> directions;
  for (uint64_t k = 0; k < many; ++k) {
    const Quat q = random.orientation();
    directions.push_back(axis_x(rotation_of(make_quat(q[0], q[1], q[2], q[3]))));
  }
  return directions;
}

struct Answers {
  std::vector<uint32_t> vertices;
  double nanoseconds = 0;
};
Answers answers_of(const hull_tables &tables, const std::vector<vec3> &directions)
{
  const hull_ranges ranges = ranges_of_hull(&tables, 0);
  Answers answers{std::vector<uint32_t>(directions.size()), 0};
  answers.nanoseconds = 1e300;
  for (int k = 0; k < repetitions; ++k) {
    const auto start = std::chrono::steady_clock::now();
    for (size_t d = 0; d < directions.size(); ++d)
      answers.vertices[d] = hull_support(&tables, &ranges, directions[d], make_vec3(1, 0.75f, 0.5f));
    const double whole = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    answers.nanoseconds = std::min(answers.nanoseconds, whole / double(directions.size()));
  }
  return answers;
}

SupportTime time_of(const Shape &shape, uint32_t cells, const std::vector<vec3> &directions)
{
  const Tables tables(shape, cells);
  const hull_tables plain = tables.of(SUPPORT_BRUTE_FORCE);
  const hull_ranges ranges = ranges_of_hull(&plain, 0);
  const Answers brute = answers_of(plain, directions),
                climbed = answers_of(tables.of(SUPPORT_HILL_CLIMBING), directions),
                mapped = answers_of(tables.of(SUPPORT_CUBE_MAP), directions);
  std::vector<double> errors;
  SupportTime time{
      ranges.vertices,    cells, 24 * cells * cells, directions.size(), 0, 0, 0, brute.nanoseconds, climbed.nanoseconds,
      mapped.nanoseconds, 0};
  for (size_t k = 0; k < directions.size(); ++k) {
    const auto height = [&](uint32_t vertex, vec3 d) { return double(height_of_vertex(&plain, &ranges, vertex, d)); };
    const vec3 d = directions[k], back = negate(d);
    const double top = height(brute.vertices[k], d), extent = top + height(highest_vertex(&plain, &ranges, back), back);
    errors.push_back((top - height(mapped.vertices[k], d)) / extent);
    time.share_wrong += double(mapped.vertices[k] != brute.vertices[k]) / double(directions.size());
    time.differences += climbed.vertices[k] != brute.vertices[k];
  }
  std::sort(errors.begin(), errors.end());
  time.largest_error = errors.back();
  time.error_999 = errors[errors.size() * 999 / 1000];
  return time;
}

} // namespace

std::vector<SupportTime> bench_support(uint64_t many)
{
  const std::vector<vec3> directions = directions_of(many);
  std::vector<SupportTime> times;
  for (uint32_t vertices : {8u, 32u, 128u, 1000u})
    for (uint32_t cells : {4u, 8u, 16u, 32u, 64u}) times.push_back(time_of(ellipsoid(vertices), cells, directions));
  return times;
}

std::string support_text(const std::vector<SupportTime> &times)
{
  Table table({"vertices", "cells", "map KiB", "largest error", "99.9%", "another vertex", "ns brute-force",
               "hill-climbing", "cube-map", "differences"});
  for (const SupportTime &t : times)
    table.add({fmt::format("{}", t.vertices), fmt::format("{}", t.cells), fmt::format("{:.1f}", t.bytes / 1024.0),
               fmt::format("{:.2e}", t.largest_error), fmt::format("{:.2e}", t.error_999),
               fmt::format("{:.1f} %", 100 * t.share_wrong), fmt::format("{:.1f}", t.brute_force),
               fmt::format("{:.1f}", t.hill_climbing), fmt::format("{:.1f}", t.cube_map),
               fmt::format("{}", t.differences)});
  return table.text("  ");
}

Json support_json(const std::vector<SupportTime> &times)
{
  Json json = Json::array();
  for (const SupportTime &t : times)
    json.push_back(
        {{"vertices", t.vertices},
         {"cells", t.cells},
         {"map_bytes", t.bytes},
         {"directions", t.directions},
         {"error",
          {{"largest", t.largest_error}, {"percentile_99_9", t.error_999}, {"share_other_vertex", t.share_wrong}}},
         {"ns", {{"brute-force", t.brute_force}, {"hill-climbing", t.hill_climbing}, {"cube-map", t.cube_map}}},
         {"differences", t.differences}});
  return json;
}

int execute_support(const BenchOptions &options)
{
  const uint64_t directions =
      options.count.empty() ? 200000 : whole_number("--n", options.count, 1000, uint64_t{1} << 28);
  options.json.check();
  const std::vector<SupportTime> times = bench_support(directions);
  if (!options.json.takes_standard_output())
    fmt::print("support: {} directions of each hull\n{}", directions, support_text(times));
  options.json.write({{"what", options.what}, {"n", directions}, {"hulls", support_json(times)}});
  return std::any_of(times.begin(), times.end(), [](const SupportTime &time) { return time.differences > 0; }) ? 1 : 0;
}

} // namespace tandem
