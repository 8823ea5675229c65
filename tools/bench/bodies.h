/* bodies.h - `tandem bench bodies`: the cost of bodies that come and go while a world runs, and of reading one. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

/* Of one world; each time includes the wait for the device and the kernels that apply the calls. */
struct BodyTimes {
  uint64_t bodies = 0;
  double grow = 0;            /* the first World::create_bodies, which lays out buffers with room for them, ms */
  Spread create{}, destroy{}; /* World::create_bodies and World::destroy_bodies of all of them */
  Spread create_singly{};     /* World::create_body for each of them */
  Spread step_after_create{}, read{}; /* the step in which they are new, and World::read_body of one */
};

/* Boxes that lie on a floor without touching, created in a world that has the floor and one box. */
BodyTimes bench_bodies(const std::string &backend, uint64_t bodies, bool allow_inexact);

std::string bodies_text(const std::vector<BodyTimes> &times);
Json bodies_json(const std::vector<BodyTimes> &times);

int execute_bodies(const BenchOptions &options);

} // namespace tandem
