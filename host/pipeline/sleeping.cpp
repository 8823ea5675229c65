/* sleeping.cpp - see sleeping.h. */
#include "host/pipeline/sleeping.h"

#include <algorithm>

#include "host/pipeline/primitives.h"
#include "shared/platform.h"

namespace tandem {
namespace {

constexpr unsigned sleeper_key_bits = 31; /* three coordinates of ten bits, and one for what is large */
constexpr uint32_t moved_elements = 4;    /* of a row that one launch moves, as moved_float4s has them */

struct RowKernels {
  Kernel gather, scatter;
  Buffer moved;
};
RowKernels kernels_of(Element element)
{
  if (element == Element::float4) return {Kernel::gather_float4s, Kernel::scatter_float4s, Buffer::moved_float4s};
  if (element == Element::real) return {Kernel::gather_reals, Kernel::scatter_reals, Buffer::moved_reals};
  return {Kernel::gather_uints, Kernel::scatter_uints, Buffer::moved_uints};
}

/* hook: of contacts, by their constraints or by their pairs. */
void find_islands(StepLaunches &step, Kernel hook)
{
  const uint32_t rounds = step.plan().island_rounds;
  step.run(Kernel::begin_islands);
  for (uint32_t round = 0; round < rounds; ++round) {
    step.run(hook, {round});
    if (step.has(FEATURE_JOINTS)) step.run(Kernel::hook_joints, {round});
    if (step.has(FEATURE_COUPLINGS)) step.run(Kernel::hook_couplings, {round});
    if (step.has_links()) step.run(Kernel::hook_links, {round});
    step.run(Kernel::jump_islands, {round});
    step.run(Kernel::follow_labels);
  }
  step.run(Kernel::finish_islands, {rounds});
}

} // namespace

/* This comes before the bounds of the step, which take the place of those computed here. */
void list_sleepers(StepLaunches &step)
{
  step.run_range(Kernel::compute_query_bounds, COUNT_BODIES, COUNT_ALL_BODIES);
  step.run_range(Kernel::measure_sleepers, COUNT_BODIES, COUNT_ALL_BODIES);
  step.run_range(Kernel::sleeper_keys, COUNT_BODIES, COUNT_ALL_BODIES);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_SLEEPERS, step.plan().bodies, 0, sleeper_key_bits);
  step.run(Kernel::keep_sleepers);
}

void append_sleepers(StepLaunches &step, uint32_t fallen)
{
  for (const Kernel kernel : {Kernel::compute_query_bounds, Kernel::append_sleepers})
    step.launcher().launch({kernel, {}, {}, COUNT_BODIES, COUNT_LENGTH, fallen});
}

void renumber_sleepers(Launcher &launcher, uint32_t awake, uint32_t most)
{
  move_body_rows(launcher, {Buffer::sleeper_place, {Buffer::sleeper_place}}, COUNT_LENGTH, most);
  launcher.launch({Kernel::renumber_sleepers, {}, {awake}, COUNT_ZERO, COUNT_LENGTH, most});
}

void find_near_sleepers(StepLaunches &step)
{
  step.run(Kernel::near_sleepers_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::near_sleepers_write);
}

/* Islands are found only if a body of the last step had rested for long enough. */
void find_drowsy_islands(StepLaunches &step)
{
  step.run(Kernel::count_rest);
  if (step.has(FEATURE_JOINT_AXES)) step.run(Kernel::disturb_driven);
  if (step.has_links()) step.run(Kernel::disturb_driven_links);
  if (!step.plan().drowsy) return;
  find_islands(step, Kernel::hook_islands);
  step.run(Kernel::keep_islands_awake);
  step.run(Kernel::keep_carried_awake);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::keep_joined_awake);
  if (step.has(FEATURE_TRIGGER)) step.run(Kernel::keep_triggers_awake);
  step.run(Kernel::choose_sleepers);
}

void part_islands(StepLaunches &step)
{
  find_islands(step, Kernel::hook_pairs);
  step.run(Kernel::gather_wishes);
  step.run(Kernel::class_bodies);
}

void move_body_rows(Launcher &launcher, const BodyRows &rows, uint32_t length, uint32_t most)
{
  const BufferRow &row = row_of(rows.from);
  const RowKernels kernels = kernels_of(row.element);
  for (uint32_t first = 0; first < row.per_item; first += moved_elements) {
    const uint32_t count = std::min(moved_elements, row.per_item - first);
    const Values part{row.per_item, first, count};
    launcher.launch({kernels.gather, {rows.from, Buffer::move_from, kernels.moved}, part, COUNT_ZERO, length, most});
    for (const Buffer to : rows.to)
      launcher.launch({kernels.scatter, {kernels.moved, Buffer::move_to, to}, part, COUNT_ZERO, length, most});
  }
}

void move_planes(Launcher &launcher, const BodyRows &rows, const Planes &planes, uint32_t length, uint32_t most)
{
  const RowKernels kernels = kernels_of(row_of(rows.from).element);
  for (uint32_t plane = 0; plane < planes.count; ++plane) {
    const Values part{1, plane * planes.stride, 1};
    launcher.launch({kernels.gather, {rows.from, Buffer::move_from, kernels.moved}, part, COUNT_ZERO, length, most});
    for (const Buffer to : rows.to)
      launcher.launch({kernels.scatter, {kernels.moved, Buffer::move_to, to}, part, COUNT_ZERO, length, most});
  }
}

void place_awake_first(StepLaunches &step, uint32_t cached_pairs)
{
  const uint32_t bodies = step.plan().bodies;
  exclusive_scan(step.launcher(), Buffer::falls_asleep, Buffer::sleepers_before, Buffer::scan_sums, COUNT_BODIES,
                 bodies);
  step.run(Kernel::stop_sleepers);
  step.run(Kernel::place_awake_first);
  step.run(Kernel::count_awake_pairs);
  exclusive_scan(step.launcher(), Buffer::awake_pair_start, Buffer::awake_pair_start, Buffer::scan_sums, COUNT_BODIES,
                 bodies);
  step.run(Kernel::place_cached_pairs);
  step.launcher().launch({Kernel::renumber_cached, {}, {}, COUNT_ZERO, COUNT_LENGTH, cached_pairs});
  step.run_range(Kernel::copy, COUNT_ZERO, COUNT_BODIES_PLUS_ONE, {}, {Buffer::awake_pair_start, Buffer::cached_start});
}

void move_pair_rows(Launcher &launcher, Buffer from, Buffer to, uint32_t cached_pairs)
{
  const BufferRow &row = row_of(from);
  launcher.launch({kernels_of(row.element).scatter,
                   {from, Buffer::pair_target, to},
                   {row.per_item, 0, row.per_item},
                   COUNT_ZERO,
                   COUNT_LENGTH,
                   cached_pairs});
}

} // namespace tandem
