/* floors.h - `tandem bench floors`: the bytes that each stage of a step must move, the time that a copy of as many
 * bytes takes on the same backend, and the time that the stage takes. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/backend.h>
#include <tandem/world.h>

#include "tools/bench/options.h"
#include "tools/command/output.h"

namespace tandem {

struct StageFloor {
  std::string stage;
  uint64_t launches = 0;
  uint64_t bytes = 0; /* read and written, each number once a launch */
  double floor_milliseconds = 0, milliseconds = 0;
};

struct Floors {
  std::string scene;
  uint64_t bodies = 0, pairs = 0;
  double bytes_per_second = 0; /* of a copy of 256 MiB, read and written */
  double step_milliseconds = 0;
  std::vector<StageFloor> stages; /* in pipeline order */
};

/* The least that a launch of the last step must read and write. */
uint64_t least_bytes(World &world, const Launch &launch);

/* scene: as load_scene reads it. Times are medians or means of steps 60 to 120. */
Floors bench_floors(const std::string &scene, const Placement &placement);

std::string floors_text(const Floors &floors);
std::string floors_markdown(const Floors &floors);
Json floors_json(const Floors &floors);

int execute_floors(const BenchOptions &options);

} // namespace tandem
