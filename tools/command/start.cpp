/* start.cpp - see start.h. */
#include "tools/command/start.h"

#include <fmt/format.h>
#include <unistd.h>

#include <tandem/error.h>

#include "host/base/printable.h"

namespace tandem {

Start start_from(const std::string &text)
{
  if (text == "device") return Start::on_device;
  if (text == "cpu") return Start::on_cpu;
  throw InputError(fmt::format("--start '{}': no place for first steps; use cpu or device", printable(text)));
}

std::string start_text(const PlacementReport &report, bool is_placed)
{
  const PlacementReport::Building &building = report.building;
  if (!is_placed)
    return fmt::format("all {} steps without the device: {} of {} kernels were built in {:.1f} s",
                       building.steps_on_cpu, building.built, building.kernels, building.milliseconds * 1e-3);
  if (building.kernels == 0) return fmt::format("on {}, nothing had to be built", report.on);
  return fmt::format("{} steps with tbb in its place, while {} kernels were built in {:.1f} s; then {}",
                     building.steps_on_cpu, building.kernels, building.milliseconds * 1e-3, report.on);
}

/* Where nobody looks, no other thread builds than without a bar. */
void BuildingBar::watch(Placement &placement)
{
  if (!isatty(STDERR_FILENO)) return;
  placement.while_building = [bar = bar_](size_t built, size_t kernels) {
    if (!*bar) bar->emplace("building kernels", kernels);
    (*bar)->update(built);
  };
}

} // namespace tandem
