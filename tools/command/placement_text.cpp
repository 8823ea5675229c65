/* placement_text.cpp - see placement_text.h. */
#include "tools/command/placement_text.h"

#include <fmt/format.h>

namespace tandem {

std::string placement_text(const PlacementReport &report)
{
  std::string text = fmt::format("{}, {}", report.on, report.why);
  const char *between = ": ";
  for (const PlacementReport::Time &time : report.times) {
    text += fmt::format("{}{} {:.3f} ms a step", between, time.on, time.milliseconds);
    between = "; ";
  }
  return text;
}

Json placement_json(const PlacementReport &report)
{
  Json times = Json::array(), stages = Json::array();
  for (const PlacementReport::Time &time : report.times)
    times.push_back({{"on", time.on}, {"step_ms", time.milliseconds}});
  for (const PlacementReport::StageTimes &stage : report.stages)
    stages.push_back({{"name", stage.stage}, {"cpu_ms", stage.on_cpu}, {"device_ms", stage.on_device}});
  const PlacementReport::Building &building = report.building;
  return {{"on", report.on},
          {"why", report.why},
          {"settled", report.settled},
          {"measured", times},
          {"stages", stages},
          {"building",
           {{"steps_on_cpu", building.steps_on_cpu},
            {"moved_after", building.moved_after},
            {"ms", building.milliseconds},
            {"built", building.built},
            {"kernels", building.kernels}}}};
}

std::string stage_times_table(const PlacementReport &report)
{
  if (report.stages.empty()) return "";
  Table table({"stage", "ms on the CPU", "ms on the device"});
  for (const PlacementReport::StageTimes &stage : report.stages)
    table.add({stage.stage, fmt::format("{:.3f}", stage.on_cpu), fmt::format("{:.3f}", stage.on_device)});
  return table.text("  ");
}

} // namespace tandem
