/* extension_launches.cpp - launches of users' modules within a step or between steps. They are checked before they run,
 * because a kernel that reads or writes beyond its buffers would corrupt the whole simulation. */
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <tandem/error.h>
#include <tandem/module.h>

#include "host/pipeline/scene_counts.h"
#include "host/pipeline/step_launches.h"
#include "host/runtime/interface/module.h"

namespace tandem {
namespace {

[[noreturn]] void refuse(const KernelRow &row, const std::string &why)
{
  throw InputError(fmt::format("kernel '{}' cannot be launched: {}", row.name, why));
}

void check_is_of_extension(const KernelRow &row, const Settings &settings)
{
  const auto has_it = [&](const Extension &extension) { return extension.module->stage() == row.stage; };
  if (std::none_of(settings.extensions.begin(), settings.extensions.end(), has_it))
    refuse(row, "it is of no module in Settings::extensions");
}

/* The largest number of items in a step. The pipeline's other counts have no bound that is known in advance. */
uint32_t most_items(const KernelRow &row, const StepPlan &plan)
{
  if (is_told_by_scene(row.items)) return plan.known[row.items];
  switch (row.items) {
  case COUNT_ONE: return 1;
  case COUNT_COMMIT_BODIES: return plan.bodies;
  case COUNT_COMMIT_BODIES_PLUS_ONE: return plan.bodies + 1;
  case COUNT_PAIRS:
  case COUNT_CONSTRAINTS:
  case COUNT_COMMIT_PAIRS:
  case COUNT_COMMIT_CONSTRAINTS: return plan.capacity_pairs;
  default:
    refuse(row,
           "its row may name ONE, BODIES, BODIES_PLUS_ONE, PAIRS, CONSTRAINTS, or COMMIT_ and one of these but ONE, "
           "as its items");
  }
}

bool is_of_commit(uint32_t items)
{
  return items == COUNT_COMMIT_BODIES || items == COUNT_COMMIT_BODIES_PLUS_ONE || items == COUNT_COMMIT_PAIRS ||
         items == COUNT_COMMIT_CONSTRAINTS;
}

/* A step may run again from its begin, so lasting state may be written only at the commit. */
void check_may_write(const KernelRow &row, Buffer buffer, std::optional<StepPoint> point)
{
  const Lifetime lifetime = row_of(buffer).lifetime;
  if (!point || lifetime == Lifetime::SCRATCH || lifetime == Lifetime::KEPT) return;
  if (*point == StepPoint::commit && is_of_commit(row.items) && index_of(buffer) >= buffer_count &&
      lifetime != Lifetime::SCENE)
    return;
  refuse(row,
         fmt::format("buffer '{}' lasts beyond the step, so it is written between steps, or if it is STATE or CACHE "
                     "of a module at StepPoint::commit over COMMIT_ items",
                     row_of(buffer).name));
}

/* How many hits a kernel may read, a row for each query: one for each of its items, or for each body that it looks
 * up. */
uint32_t hits_needed(const KernelRow &row, const StepPlan &plan)
{
  const uint32_t items = plan.known[row.items];
  return is_told_by_scene(row.items) ? items : std::max(items, plan.known[COUNT_ALL_BODIES]);
}

void check_has_hits(const KernelRow &row, Buffer buffer, uint32_t needed, const StepPlan &plan,
                    const Launcher &launcher)
{
  const size_t bytes = launcher.bytes(buffer);
  if (bytes == SIZE_MAX) return; /* launches are only recorded */
  const size_t hits = std::min<size_t>(plan.hits, bytes / size_of(row_of(buffer).element));
  if (hits == 0)
    refuse(row, fmt::format("buffer '{}' is empty; World::cast_rays_on_device or cast_shapes_on_device fills it, until "
                            "another query or a step",
                            row_of(buffer).name));
  if (hits < needed)
    refuse(row, fmt::format("buffer '{}' has the hits of {} queries, and the kernel may read those of {}",
                            row_of(buffer).name, hits, needed));
}

bool holds_hits(Buffer buffer)
{
  return buffer == Buffer::query_hit || buffer == Buffer::query_point || buffer == Buffer::query_hit_body;
}

void check_is_filled(const KernelRow &row, Buffer buffer, const Launcher &launcher)
{
  if (row_of(buffer).capacity == Capacity::NOTHING && launcher.bytes(buffer) == 0)
    refuse(row, fmt::format("buffer '{}' is empty; World::write gives it its size", row_of(buffer).name));
}

void check_slot(const KernelRow &row, const Argument &argument, Buffer given, uint32_t items, const Launcher &launcher)
{
  if (row_of(given).element != argument.element)
    refuse(row, fmt::format("buffer '{}' has elements of another type than the slot '{}'", row_of(given).name,
                            argument.name));
  if (launcher.bytes(given) / size_of(argument.element) < items)
    refuse(row,
           fmt::format("buffer '{}' has room for {} elements in this world, and slot '{}' is for up to {}",
                       row_of(given).name, launcher.bytes(given) / size_of(argument.element), argument.name, items));
}

void check_numbers(const KernelRow &row, const Values &values, const Slots &slots)
{
  const auto count = [&](Argument::Kind kind) {
    return static_cast<size_t>(std::count_if(row.arguments.begin(), row.arguments.end(),
                                             [&](const Argument &argument) { return argument.kind == kind; }));
  };
  const size_t wanted_values = count(Argument::Kind::value), wanted_slots = count(Argument::Kind::slot);
  if (values.size() != wanted_values || slots.size() != wanted_slots)
    refuse(row, fmt::format("it takes {} values and {} slots, not {} and {}", wanted_values, wanted_slots,
                            values.size(), slots.size()));
}

class ExtensionLaunches : public Launches {
public:
  ExtensionLaunches(StepLaunches &step, StepPoint point) : step_(step), point_(point) {}
  void run(Kernel kernel, std::span<const uint32_t> values, std::span<const Buffer> slots) override
  {
    step_.run_of_module(kernel, values, slots, point_);
  }
  const Settings &settings() const override { return step_.settings(); }

private:
  StepLaunches &step_;
  StepPoint point_;
};

} // namespace

void StepLaunches::run_of_module(Kernel kernel, const Values &values, const Slots &slots,
                                 std::optional<StepPoint> point)
{
  const KernelRow &row = row_of(kernel);
  check_is_of_extension(row, settings_);
  if (row.feature != 0 && !has(row.feature)) return;
  const uint32_t most = most_items(row, plan_);
  check_numbers(row, values, slots);
  size_t slot = 0;
  for (const Argument &argument : row.arguments) {
    if (argument.kind == Argument::Kind::value) continue;
    const bool is_slot = argument.kind == Argument::Kind::slot;
    const Buffer buffer = is_slot ? slots.at(slot++) : argument.buffer;
    if (is_slot) check_slot(row, argument, buffer, most, launcher_);
    if (holds_hits(buffer)) check_has_hits(row, buffer, hits_needed(row, plan_), plan_, launcher_);
    else check_is_filled(row, buffer, launcher_);
    if (argument.access != Access::in) check_may_write(row, buffer, point);
  }
  if (row.execution == Execution::group) run_at_most(kernel, most, values, slots);
  else run(kernel, values, slots);
}

void StepLaunches::run_extensions(StepPoint point)
{
  if (settings_.extensions.empty()) return;
  ExtensionLaunches launches(*this, point);
  for (const Extension &extension : settings_.extensions)
    for (const auto &[at, launch] : extension.launches)
      if (at == point) launch(launches);
}

} // namespace tandem
