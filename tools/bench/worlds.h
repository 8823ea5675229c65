/* worlds.h - `tandem bench worlds`: a step of many small worlds in a batch, beside worlds stepped one after another. */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct WorldsTime {
  std::string scene; /* each world has a seed of its own */
  uint32_t worlds = 0;
  size_t bodies = 0;         /* of each world */
  Measurement batch;         /* a step of all worlds */
  double alone = 0;          /* ms, a step of one World by itself, on average over some */
  uint32_t worlds_alone = 0; /* that were stepped in turn for it */
};

/* The two batches for which there are targets: 1,024 worlds of 8 boxes and 4,096 of a pile of 10, or so many of
 * each. */
std::vector<WorldsTime> bench_worlds(const std::string &backend, std::optional<uint32_t> worlds, bool allow_inexact);

std::string worlds_text(const std::vector<WorldsTime> &times);
Json worlds_json(const std::vector<WorldsTime> &times);

int execute_worlds(const BenchOptions &options);

} // namespace tandem
