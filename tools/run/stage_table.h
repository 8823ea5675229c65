/* stage_table.h - the time of each stage of a run, as text and as JSON. */
#pragma once

#include <string>

#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

Json stages_json(const Measurement &measurement);
std::string stage_table(const Measurement &measurement);

} // namespace tandem
