/* start.h - where a run takes its first steps: the option --start, and what people see while kernels are built. */
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tandem/world.h>

#include "tools/command/progress.h"

namespace tandem {

/* InputError for what is neither "cpu" nor "device". */
Start start_from(const std::string &text);

/* "38 steps with tbb in its place, while 29 kernels were built in 6.1 s; then cl:0.0" */
std::string start_text(const PlacementReport &report, bool is_placed);

/* A bar on a terminal while a world waits for kernels for over a second. */
class BuildingBar {
public:
  void watch(Placement &placement);
  void clear() { bar_->reset(); }

private:
  std::shared_ptr<std::optional<Progress>> bar_ = std::make_shared<std::optional<Progress>>();
};

} // namespace tandem
