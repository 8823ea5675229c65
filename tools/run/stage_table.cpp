/* stage_table.cpp - see stage_table.h. */
#include "tools/run/stage_table.h"

#include <fmt/format.h>

namespace tandem {

Json stages_json(const Measurement &measurement)
{
  Json stages = Json::array();
  for (const StageTime &stage : measurement.stages)
    stages.push_back({{"name", stage.name}, {"backend", stage.backend}, {"ms", stage.milliseconds}});
  return stages;
}

std::string stage_table(const Measurement &measurement)
{
  Table table({"stage", "ms/step", "backend"});
  double sum = 0;
  for (const StageTime &stage : measurement.stages) {
    table.add({stage.name, fmt::format("{:.3f}", stage.milliseconds), stage.backend});
    sum += stage.milliseconds;
  }
  table.add({"kernels, sum", fmt::format("{:.3f}", sum), ""});
  const Spread &step = measurement.step_milliseconds;
  table.add({"whole step", fmt::format("{:.3f}", step.median), ""});
  return table.text("  ") + fmt::format("  whole step: median of {} steps, {:.3f} to {:.3f} ms\n",
                                        measurement.timed_steps, step.minimum, step.maximum);
}

} // namespace tandem
