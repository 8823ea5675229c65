/* snapshots.h - `tandem bench snapshots`: what it costs to keep a state on the device, to go back to one, and to save a
 * world to the host. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

/* Of one world; each time includes the wait for the device. */
struct SnapshotTimes {
  std::string scene;
  uint64_t bodies = 0, pairs = 0;
  Spread keep{}, go_back{}; /* World::keep_state, and World::go_back by one state */
  Spread save{}, restore{};
  uint64_t snapshot_bytes = 0;

  double save_gigabytes_per_second() const;
};

/* A cube of about so many boxes that have begun to rest on each other. */
SnapshotTimes bench_snapshots(const std::string &backend, uint64_t bodies, bool allow_inexact);

std::string snapshots_text(const std::vector<SnapshotTimes> &times);
Json snapshots_json(const std::vector<SnapshotTimes> &times);

int execute_snapshots(const BenchOptions &options);

} // namespace tandem
