/* breakpoint.cpp - see breakpoint.h. */
#include "host/breakpoint.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace tandem {
namespace {

uint32_t count_of(World &world, uint32_t entry) { return world.memory().read<uint32_t>(Buffer::counts, 1, entry).at(0); }

bool is_allocated(World &world, Buffer buffer, size_t item) { return (item + 1) * sizeof(uint32_t) <= world.memory().bytes(buffer); }

std::string_view name_of_buffer(Buffer buffer) { return row_of(buffer).name; }

/* Rows of pairs come in three orders: that of the pairs, of the constraints (by colour), of the cache. */
bool is_by_constraint(Buffer buffer) { return name_of_buffer(buffer).starts_with("constraint_"); }

bool runs_over_constraints(const KernelRow &row)
{
  return row.items == COUNT_CONSTRAINTS || row.items == COUNT_COMMIT_CONSTRAINTS ||
         std::any_of(row.arguments.begin(), row.arguments.end(), [&](const Argument &argument) {
           return row.items == items_given && argument.kind == Argument::Kind::buffer && is_by_constraint(argument.buffer);
         });
}

/* The iteration of the launch whose constraint is about `value`, by one of the index buffers. */
std::optional<uint32_t> search(World &world, const Launch &launch, Buffer index, size_t value)
{
  const uint32_t first = count_of(world, launch.first), last = count_of(world, launch.last);
  if (last <= first || !is_allocated(world, index, last - 1)) return {};
  const std::vector<uint32_t> indices = world.memory().read<uint32_t>(index, last - first, first);
  const auto found = std::find(indices.begin(), indices.end(), static_cast<uint32_t>(value));
  if (found == indices.end()) return {};
  return first + static_cast<uint32_t>(found - indices.begin());
}

std::optional<uint32_t> iteration_that_wrote(World &world, const Launch &launch, Buffer buffer, size_t item)
{
  const KernelRow &row = row_of(launch.kernel);
  const Capacity capacity = row_of(buffer).capacity;
  if (row.form == Form::group)
    return capacity == Capacity::TILES ? std::optional<uint32_t>(static_cast<uint32_t>(item)) : std::nullopt;
  if (runs_over_constraints(row) && capacity == Capacity::BODIES) {
    const auto as_first = search(world, launch, Buffer::constraint_a, item);
    return as_first ? as_first : search(world, launch, Buffer::constraint_b, item);
  }
  if (runs_over_constraints(row) && capacity == Capacity::PAIRS && !is_by_constraint(buffer))
    return search(world, launch, Buffer::constraint_pair, item);
  if (capacity == Capacity::PAIRS || capacity == Capacity::BODIES || capacity == Capacity::BODIES_PLUS_ONE)
    return static_cast<uint32_t>(item);
  return {};
}

std::vector<uint32_t> pair_bodies(World &world, Buffer a, Buffer b, size_t item)
{
  if (!is_allocated(world, a, item) || !is_allocated(world, b, item)) return {};
  return {world.memory().read<uint32_t>(a, 1, item).at(0), world.memory().read<uint32_t>(b, 1, item).at(0)};
}

} // namespace

size_t pair_capacity(World &world) { return count_of(world, CAPACITY_PAIRS); }

std::vector<uint32_t> bodies_of_item(World &world, Buffer buffer, size_t item)
{
  std::vector<uint32_t> found;
  const Capacity capacity = row_of(buffer).capacity;
  if (capacity == Capacity::BODIES) found = {static_cast<uint32_t>(item)};
  else if (capacity == Capacity::PAIRS && is_by_constraint(buffer))
    found = pair_bodies(world, Buffer::constraint_a, Buffer::constraint_b, item);
  else if (capacity == Capacity::PAIRS && !name_of_buffer(buffer).starts_with("cached_"))
    found = pair_bodies(world, Buffer::pair_a, Buffer::pair_b, item);
  const size_t bodies = world.scene().bodies.size();
  if (std::any_of(found.begin(), found.end(), [&](uint32_t body) { return body >= bodies; })) return {};
  for (uint32_t &body : found) body = world.scene_body(body);
  return found;
}

std::string breakpoint_for(World &world, const Launch &launch, Buffer buffer, size_t item, uint64_t step)
{
  const KernelRow &row = row_of(launch.kernel);
  const bool group = row.form == Form::group;
  const auto iteration = iteration_that_wrote(world, launch, buffer, item);
  const std::string which = iteration ? fmt::format("{} == {} && ", group ? "group" : "i", *iteration) : "";
  return fmt::format("{}_{} if {}tandem::current_step == {}", row.name, group ? "group" : "item", which, step);
}

} // namespace tandem
