/* worlds.h - `tandem run SCENE --worlds N`: that many copies of a scene in one batch. */
#pragma once

#include <cstdint>
#include <string>

#include <tandem/worlds.h>

#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct WorldsOutcome {
  std::string scene;
  uint64_t steps;
  Measurement measurement; /* of all worlds together */
  Statistics statistics;   /* the same */
  std::vector<uint64_t> hashes;
};

WorldsOutcome simulate_worlds(Worlds &worlds, const std::string &scene, uint64_t steps);
/* How many worlds have the hash of the first one; copies all do. */
size_t equal_worlds(const WorldsOutcome &outcome);

std::string worlds_text(const WorldsOutcome &outcome, const Worlds &worlds, const Placement &placement);
Json worlds_json(const WorldsOutcome &outcome, const Worlds &worlds, const Placement &placement);

} // namespace tandem
