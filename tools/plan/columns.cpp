/* columns.cpp - turns a plan into the two columns of its picture; see plan.h and plan_picture.h. */
#include <algorithm>

#include <fmt/format.h>

#include "host/base/printable.h"
#include "host/runtime/interface/backend.h"
#include "tools/command/output.h"
#include "tools/plan/plan.h"
#include "tools/plan/plan_picture.h"

namespace tandem {
namespace {

/* The backends in the order in which kernels name them first, which gives them their colours. */
class Colors {
public:
  size_t of(const std::string &backend)
  {
    const auto found = std::find(backends_.begin(), backends_.end(), backend);
    if (found != backends_.end()) return static_cast<size_t>(found - backends_.begin());
    backends_.push_back(backend);
    return backends_.size() - 1;
  }

private:
  std::vector<std::string> backends_;
};

/* One side of the plan: this scene's, or the one with all features. */
struct Side {
  World &world;
  bool all;
  const Plan &plan;
  bool builds(Kernel kernel) const { return all ? plan.builds_with_all(kernel) : plan.builds(kernel); }
  uint64_t bytes(Buffer buffer) const { return all ? plan.bytes_with_all(buffer) : plan.bytes(buffer); }
};

PlanBox box_of(const Side &side, Kernel kernel, Colors &colors)
{
  const std::string name = row_of(kernel).name, reason = what_brings_in(kernel);
  if (!side.builds(kernel)) return {name, reason, name + ": left out; it comes with " + reason, false, std::nullopt};
  const std::string backend = side.world.backend_of(kernel).name();
  return {name, backend, name + ": on " + backend, true, colors.of(backend)};
}

PlanBox box_of(const Side &side, Buffer buffer)
{
  const std::string name = row_of(buffer).name, reason = what_brings_in(buffer);
  const uint64_t bytes = side.bytes(buffer);
  if (bytes == 0) return {name, reason, name + ": left out; it comes with " + reason, false, std::nullopt};
  return {name, bytes_text(bytes), fmt::format("{}: {} bytes, {}", name, bytes, row_of(buffer).fields), true,
          std::nullopt};
}

bool is_kept_anywhere(const Plan &plan, Buffer buffer)
{
  return plan.bytes(buffer) > 0 || plan.bytes_with_all(buffer) > 0;
}

PlanStage stage_of(const Side &side, const StageSum &sum, Colors &colors)
{
  PlanStage stage{name_of(sum.stage),
                  fmt::format("{} of {} kernels, {}", side.all ? sum.kernels_with_all : sum.kernels, sum.kernels_of_all,
                              bytes_text(side.all ? sum.bytes_with_all : sum.bytes)),
                  {},
                  {}};
  for (size_t k = 0; k < kernel_count; ++k)
    if (row_of(kernel_at(k)).stage == sum.stage) stage.kernels.push_back(box_of(side, kernel_at(k), colors));
  for (size_t b = 0; b < buffer_count; ++b)
    if (stage_of(buffer_at(b)) == sum.stage && is_kept_anywhere(side.plan, buffer_at(b)))
      stage.buffers.push_back(box_of(side, buffer_at(b)));
  return stage;
}

PlanColumn column_of(const Side &side, const std::string &title, Colors &colors)
{
  uint64_t bytes = 0;
  size_t kernels = 0;
  PlanColumn column{title, "", {}};
  for (const StageSum &sum : sums_by_stage(side.plan)) {
    bytes += side.all ? sum.bytes_with_all : sum.bytes;
    kernels += side.all ? sum.kernels_with_all : sum.kernels;
    column.stages.push_back(stage_of(side, sum, colors));
  }
  column.summary = fmt::format("{} of {} kernels (coloured by backend), {} of buffers (outlined); grey: left out",
                               kernels, kernel_count, bytes_text(bytes));
  return column;
}

} // namespace

std::string picture_of(const Plan &plan, const std::string &scene)
{
  Colors colors;
  return svg_of(fmt::format("What {} needs", printable(scene)),
                {column_of({plan.chosen, false, plan}, "this scene", colors),
                 column_of({plan.everything, true, plan}, "with every feature", colors)});
}

} // namespace tandem
