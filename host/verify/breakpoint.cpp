/* breakpoint.cpp - maps elements of buffers to bodies and to the items of kernels; see breakpoint.h. */
#include "host/verify/breakpoint.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"

namespace tandem {
namespace {

uint32_t count_of(World &world, uint32_t entry)
{
  return world.memory().read<uint32_t>(Buffer::counts, 1, entry).at(0);
}

bool is_allocated(World &world, Buffer buffer, size_t item)
{
  return (item + 1) * sizeof(uint32_t) <= world.memory().bytes(buffer);
}

std::string_view name_of_buffer(Buffer buffer) { return row_of(buffer).name; }

/* Elements of pairs are in one of three orders: that of the pairs, of the constraints (by colour), or of the cache. */
bool is_by_constraint(Buffer buffer) { return name_of_buffer(buffer).starts_with("constraint_"); }

/* Buffers whose items are numbered like the iterations of the kernel, whatever those stand for. */
bool is_by_item(Buffer buffer)
{
  return buffer == Buffer::key_start || buffer == Buffer::small_neighbors || buffer == Buffer::large_neighbors ||
         buffer == Buffer::neighbors || buffer == Buffer::grid_neighbors;
}

bool names_buffer(const KernelRow &row, bool (*wanted)(Buffer))
{
  return std::any_of(row.arguments.begin(), row.arguments.end(), [&](const Argument &argument) {
    return argument.kind == Argument::Kind::buffer && wanted(argument.buffer);
  });
}

/* What the iterations of a kernel, or the items of a buffer, stand for. */
enum class Domain { bodies, bodies_in_grid_order, bodies_on_curve, pairs, constraints, place, unknown };

Domain domain_of(const KernelRow &row)
{
  switch (row.items) {
  case COUNT_BODIES:
    if (names_buffer(row, [](Buffer buffer) { return buffer == Buffer::cell_start; }))
      return Domain::bodies_in_grid_order;
    if (names_buffer(row, [](Buffer buffer) { return buffer == Buffer::hierarchy; })) return Domain::bodies_on_curve;
    return Domain::bodies;
  case COUNT_BODIES_PLUS_ONE:
  case COUNT_COMMIT_BODIES:
  case COUNT_COMMIT_BODIES_PLUS_ONE: return Domain::bodies;
  case COUNT_PAIRS:
  case COUNT_COMMIT_PAIRS: return Domain::pairs;
  case COUNT_CONSTRAINTS:
  case COUNT_COMMIT_CONSTRAINTS: return Domain::constraints;
  case COUNT_BOUNDED:
  case COUNT_SMALL: return Domain::place;
  case items_given: return names_buffer(row, is_by_constraint) ? Domain::constraints : Domain::place;
  default: return Domain::unknown;
  }
}

Domain domain_of(Buffer buffer)
{
  switch (row_of(buffer).capacity) {
  case Capacity::BODIES:
  case Capacity::BODIES_PLUS_ONE: return Domain::bodies;
  case Capacity::PAIRS: return is_by_constraint(buffer) ? Domain::constraints : Domain::pairs;
  case Capacity::SORTABLE:
  case Capacity::NOTHING: return Domain::place;
  default: return Domain::unknown;
  }
}

/* The index in [first, last) at which an index buffer holds `value`. */
std::optional<uint32_t> search(World &world, Buffer index, uint32_t first, uint32_t last, uint32_t value)
{
  if (last <= first || !is_allocated(world, index, last - 1)) return {};
  const std::vector<uint32_t> indices = world.memory().read<uint32_t>(index, last - first, first);
  const auto found = std::find(indices.begin(), indices.end(), value);
  if (found == indices.end()) return {};
  return first + static_cast<uint32_t>(found - indices.begin());
}

/* The iteration of a kernel over constraints that wrote the element of a body or of a pair. */
std::optional<uint32_t> constraint_of(World &world, const Launch &launch, Domain written, uint32_t item)
{
  const uint32_t first = count_of(world, launch.first), last = count_of(world, launch.last);
  if (written == Domain::pairs) return search(world, Buffer::constraint_pair, first, last, item);
  if (written != Domain::bodies) return {};
  const auto as_first = search(world, Buffer::constraint_a, first, last, item);
  return as_first ? as_first : search(world, Buffer::constraint_b, first, last, item);
}

/* Kernels of the grid and of the hierarchy visit the first bodies, then the others in their sorted order. */
std::optional<uint32_t> place_in_order(World &world, Buffer list, uint32_t unsorted, uint32_t body)
{
  if (body < unsorted) return body;
  const auto place = search(world, list, 0, count_of(world, COUNT_BODIES) - unsorted, body);
  return place ? std::optional<uint32_t>(*place + unsorted) : std::nullopt;
}

std::optional<uint32_t> iteration_of_body(World &world, Domain runs, uint32_t body)
{
  if (runs == Domain::bodies_in_grid_order)
    return place_in_order(world, Buffer::sort_value, count_of(world, COUNT_LARGE), body);
  if (runs == Domain::bodies_on_curve)
    return place_in_order(world, Buffer::leaf_body, count_of(world, COUNT_UNBOUNDED), body);
  return body;
}

std::optional<uint32_t> owner_of_pair(World &world, uint32_t pair)
{
  if (!is_allocated(world, Buffer::pair_a, pair)) return {};
  return world.memory().read<uint32_t>(Buffer::pair_a, 1, pair).at(0);
}

/* Kernels of pairs run over the list of their kind if the scene has lists. */
bool runs_over_list(const Launch &launch)
{
  return launch.first >= KIND_START && launch.first < KIND_START + uint32_t{PAIR_KIND_NONE};
}

std::optional<uint32_t> place_in_list(World &world, const Launch &launch, uint32_t pair)
{
  return search(world, Buffer::pair_of_kind, count_of(world, launch.first), count_of(world, launch.last), pair);
}

/* Nothing if several iterations wrote the element (atomics), or if the kernel scatters. */
std::optional<uint32_t> iteration_that_wrote(World &world, const Launch &launch, Buffer buffer, uint32_t item)
{
  const KernelRow &row = row_of(launch.kernel);
  const Domain runs = domain_of(row), written = domain_of(buffer);
  if (row.execution == Execution::group)
    return row_of(buffer).capacity == Capacity::TILES ? std::optional(item) : std::nullopt;
  if (is_by_item(buffer)) return item;
  if (runs == Domain::unknown || written == Domain::unknown || (buffer == Buffer::pair_key && runs != Domain::pairs))
    return {};
  if (runs_over_list(launch)) return written == Domain::pairs ? place_in_list(world, launch, item) : std::nullopt;
  if (runs == Domain::constraints && written != Domain::constraints) return constraint_of(world, launch, written, item);
  if (runs == Domain::bodies || runs == Domain::bodies_in_grid_order || runs == Domain::bodies_on_curve) {
    const std::optional<uint32_t> body = written == Domain::pairs ? owner_of_pair(world, item) : std::optional(item);
    return body ? iteration_of_body(world, runs, *body) : body;
  }
  if (runs == written || written == Domain::place) return item;
  return {};
}

/* Elements of pairs are in the order of the pairs, except those of the lists. */
size_t pair_of_row(World &world, Buffer buffer, size_t item)
{
  return buffer == Buffer::pair_of_kind ? world.memory().read<uint32_t>(buffer, 1, item).at(0) : item;
}

std::vector<uint32_t> pair_bodies(World &world, Buffer a, Buffer b, size_t item)
{
  if (!is_allocated(world, a, item) || !is_allocated(world, b, item)) return {};
  return {world.memory().read<uint32_t>(a, 1, item).at(0), world.memory().read<uint32_t>(b, 1, item).at(0)};
}

} // namespace

const char *iteration_name(Kernel kernel)
{
  if (row_of(kernel).execution == Execution::group) return "group";
  switch (kernel) {
  case Kernel::brute_force_count:
  case Kernel::brute_force_write:
  case Kernel::count_events:
  case Kernel::write_events:
  case Kernel::count_pair_events:
  case Kernel::merge_candidate_count:
  case Kernel::merge_candidate_write:
  case Kernel::filter_candidates:
  case Kernel::take_candidates:
  case Kernel::write_pair_events: return "a";
  case Kernel::merge_count:
  case Kernel::merge_write:
  case Kernel::start_pairs: return "body";
  case Kernel::color_starts:
  case Kernel::world_color_starts: return "color";
  default: return row_of(kernel).items == COUNT_ONE ? "" : "i";
  }
}

size_t pair_capacity(World &world) { return count_of(world, CAPACITY_PAIRS); }

std::vector<uint32_t> bodies_of_item(World &world, Buffer buffer, size_t item)
{
  std::vector<uint32_t> found;
  const Capacity capacity = row_of(buffer).capacity;
  if (capacity == Capacity::BODIES) found = {static_cast<uint32_t>(item)};
  else if (capacity == Capacity::PAIRS && is_by_constraint(buffer))
    found = pair_bodies(world, Buffer::constraint_a, Buffer::constraint_b, item);
  else if (capacity == Capacity::PAIRS && !name_of_buffer(buffer).starts_with("cached_"))
    found = pair_bodies(world, Buffer::pair_a, Buffer::pair_b, pair_of_row(world, buffer, item));
  const size_t bodies = world.scene().bodies.size();
  if (std::any_of(found.begin(), found.end(), [&](uint32_t body) { return body >= bodies; })) return {};
  for (uint32_t &body : found) body = world.scene_body(body);
  return found;
}

std::string breakpoint_for(World &world, const Launch &launch, Buffer buffer, size_t item, uint64_t step)
{
  const KernelRow &row = row_of(launch.kernel);
  const auto iteration = iteration_that_wrote(world, launch, buffer, static_cast<uint32_t>(item));
  const std::string which = iteration ? fmt::format("{} == {} && ", iteration_name(launch.kernel), *iteration) : "";
  const char *const ending = row.execution == Execution::host    ? ""
                             : row.execution == Execution::group ? "_group"
                                                                 : "_item";
  return fmt::format("{}{} if {}tandem::step_of_launch == {}", row.name, ending, which, step);
}

} // namespace tandem
