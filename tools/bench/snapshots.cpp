/* snapshots.cpp - times states kept on the device and snapshots; see snapshots.h. */
#include "tools/bench/snapshots.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr int state_repetitions = 51, snapshot_repetitions = 5;
constexpr uint32_t states_in_ring = 4;

template <class Work> double milliseconds_of(World &world, const Work &work)
{
  world.finish();
  const auto start = std::chrono::steady_clock::now();
  work();
  world.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void time_ring(World &world, SnapshotTimes &times)
{
  std::vector<double> keep, back;
  world.keep_states(states_in_ring, false);
  for (int k = 0; k < state_repetitions; ++k) {
    keep.push_back(milliseconds_of(world, [&] { world.keep_state(); }));
    world.step();
    world.keep_state();
    back.push_back(milliseconds_of(world, [&] { world.go_back(1); }));
  }
  world.keep_states(0);
  times.keep = spread_of(keep);
  times.go_back = spread_of(back);
}

void time_snapshots(World &world, SnapshotTimes &times)
{
  std::vector<double> save, restore;
  std::vector<std::byte> snapshot;
  world.save(snapshot); /* what comes after has its memory */
  for (int k = 0; k < snapshot_repetitions; ++k) {
    world.step(); /* what was restored lies on the host until a step brings it to the device */
    save.push_back(milliseconds_of(world, [&] { world.save(snapshot); }));
    restore.push_back(milliseconds_of(world, [&] { world.restore(snapshot); }));
    times.snapshot_bytes = snapshot.size();
  }
  times.save = spread_of(save);
  times.restore = spread_of(restore);
}

} // namespace

double SnapshotTimes::save_gigabytes_per_second() const
{
  return static_cast<double>(snapshot_bytes) / std::max(save.median, 1e-9) * 1e-6;
}

SnapshotTimes bench_snapshots(const std::string &backend, uint64_t bodies, bool allow_inexact)
{
  const auto side = static_cast<uint64_t>(std::max(1.0, std::round(std::cbrt(static_cast<double>(bodies)))));
  SnapshotTimes times;
  times.scene = fmt::format("box-grid:nx={0},ny={0},nz={0}", side);
  World world(load_scene(times.scene), {}, {backend, {}, allow_inexact});
  for (int k = 0; k < 20; ++k) world.step();
  times.bodies = world.body_count();
  times.pairs = world.statistics().pairs;
  time_ring(world, times);
  time_snapshots(world, times);
  return times;
}

std::string snapshots_text(const std::vector<SnapshotTimes> &times)
{
  Table table({"bodies", "pairs", "keep, ms", "go back, ms", "save, ms", "MB", "GB/s", "restore, ms"});
  for (const SnapshotTimes &row : times)
    table.add({fmt::format("{}", row.bodies), fmt::format("{}", row.pairs), fmt::format("{:.3f}", row.keep.median),
               fmt::format("{:.3f}", row.go_back.median), fmt::format("{:.2f}", row.save.median),
               fmt::format("{:.1f}", static_cast<double>(row.snapshot_bytes) * 1e-6),
               fmt::format("{:.2f}", row.save_gigabytes_per_second()), fmt::format("{:.2f}", row.restore.median)});
  return table.text("  ");
}

Json snapshots_json(const std::vector<SnapshotTimes> &times)
{
  Json json = Json::array();
  for (const SnapshotTimes &row : times)
    json.push_back({{"scene", row.scene},
                    {"bodies", row.bodies},
                    {"pairs", row.pairs},
                    {"keep_ms", spread_json(row.keep)},
                    {"go_back_ms", spread_json(row.go_back)},
                    {"save_ms", spread_json(row.save)},
                    {"snapshot_bytes", row.snapshot_bytes},
                    {"save_gb_per_s", row.save_gigabytes_per_second()},
                    {"restore_ms", spread_json(row.restore)}});
  return json;
}

int execute_snapshots(const BenchOptions &options)
{
  std::vector<uint64_t> counts{1000, 10000, 100000};
  if (!options.count.empty()) counts = {whole_number("--n", options.count, 1, most_bodies)};
  options.json.check();
  std::vector<SnapshotTimes> times;
  for (const uint64_t count : counts) times.push_back(bench_snapshots(options.on, count, options.inexact));
  if (!options.json.takes_standard_output())
    fmt::print("snapshots on {}: medians, the wait for the device included\n{}", options.on, snapshots_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"worlds", snapshots_json(times)}});
  return 0;
}

} // namespace tandem
