/* placement_text.h - where a world runs its steps and why, as `run` and `plan` say it. */
#pragma once

#include <string>

#include <tandem/world.h>

#include "tools/command/output.h"

namespace tandem {

/* "tbb, the fastest of those measured with 90 bodies and pairs: tbb 0.41 ms a step, cl:0.0 1.93" */
std::string placement_text(const PlacementReport &report);
Json placement_json(const PlacementReport &report);
/* The times of each stage on both sides; empty without any. */
std::string stage_times_table(const PlacementReport &report);

} // namespace tandem
