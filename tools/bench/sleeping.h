/* sleeping.h - `tandem bench sleeping`: the cost of a world that sleeps, of one island of forty boxes that is awake in
 * it, of waking that island, of its falling asleep, and of reading one body. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

/* Of one world; each time includes the wait for the device. */
struct SleepTimes {
  uint64_t bodies = 0;
  Spread awake{};        /* a step while all bodies are awake */
  Spread asleep{};       /* a step while all sleep */
  Spread island{};       /* a step while one island is awake */
  Spread wake{}, fall{}; /* World::wake_body with its step, and the step at whose end the island falls asleep */
  Spread read{};         /* World::read_body */
};

/* Boxes that lie on a floor without touching, and one stack of four layers of ten boxes. */
SleepTimes bench_sleeping(const std::string &backend, uint64_t bodies, bool allow_inexact);

std::string sleeping_text(const std::vector<SleepTimes> &times);
Json sleeping_json(const std::vector<SleepTimes> &times);

int execute_sleeping(const BenchOptions &options);

} // namespace tandem
