/* step_parts.cpp - derives the used part of a buffer from the counts of the step; see step_parts.h. */
#include "host/world/step_parts.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "host/pipeline/layout.h"

namespace tandem {
namespace {

struct PairRows {
  Buffer buffer;
  bool planes; /* one element an item in each plane; else records */
};

/* Buffers with an item for each pair or constraint, below the number of pairs. Lists that a broadphase keeps, keys that
 * it sorts, and partial sums have lengths of their own. */
constexpr PairRows pair_rows[] = {
    {Buffer::pair_a, false},
    {Buffer::pair_b, false},
    {Buffer::pair_of_kind, false},
    {Buffer::pair_leaf, false},
    {Buffer::manifold_normal, false},
    {Buffer::manifold_points, true},
    {Buffer::manifold_count, false},
    {Buffer::manifold_feature, false},
    {Buffer::split_axis, false},
    {Buffer::split_state, false},
    {Buffer::split_faces, false},
    {Buffer::split_point, true},
    {Buffer::split_count, false},
    {Buffer::pair_cached, false},
    {Buffer::pair_color, false},
    {Buffer::pair_constraint, false},
    {Buffer::pair_touching, false},
    {Buffer::pair_impulse, false},
    {Buffer::constraint_pair, false},
    {Buffer::constraint_a, false},
    {Buffer::constraint_b, false},
    {Buffer::constraint_normal, false},
    {Buffer::constraint_points, true},
    {Buffer::constraint_center, false},
    {Buffer::constraint_offset, false},
    {Buffer::constraint_normal_impulse, false},
    {Buffer::constraint_friction_impulse, false},
    {Buffer::constraint_restitution, true},
    {Buffer::constraint_rolling, true},
    {Buffer::constraint_slop, false},
    {Buffer::constraint_slip, false},
    {Buffer::constraint_penalty, false},
    {Buffer::constraint_impulse, false},
    {Buffer::body_constraint, false},
    {Buffer::nncg_impulse, true},
    {Buffer::nncg_direction, true},
    {Buffer::nncg_square, false},
    {Buffer::split_mass, true},
    {Buffer::split_impulse, true},
    {Buffer::split_previous_normal, false},
    {Buffer::split_previous_friction, false},
};

/* 0: the buffer is none of them. */
uint32_t planes_of(Buffer buffer, Features features)
{
  if (row_of(buffer).capacity == Capacity::PAIRS && row_of(buffer).lifetime == Lifetime::CACHE) return 1;
  const auto found = std::find_if(std::begin(pair_rows), std::end(pair_rows),
                                  [&](const PairRows &rows) { return rows.buffer == buffer; });
  if (found == std::end(pair_rows)) return 0;
  return found->planes ? elements_of_item(buffer, features) : 1;
}

/* After the broadphase they hold pairs or bodies in an order. */
bool is_sorted_list(Buffer buffer) { return buffer == Buffer::sort_key || buffer == Buffer::sort_value; }

/* What a broadphase keeps has an order of its own, and the ends of boxes lie in planes. */
bool has_rows_of_bodies(Buffer buffer)
{
  const BufferRow &row = row_of(buffer);
  if (row.capacity != Capacity::BODIES && row.capacity != Capacity::BODIES_PLUS_ONE) return false;
  return row.lifetime != Lifetime::KEPT && row.lifetime != Lifetime::SCENE && buffer != Buffer::axis_order &&
         buffer != Buffer::axis_place;
}

/* The stages after the last one that may still change the number of pairs. */
bool comes_after_pairs(Stage stage)
{
  constexpr Stage later[] = {Stage::narrowphase, Stage::batching, Stage::setup,    Stage::forces,
                             Stage::joints, Stage::solve,       Stage::events,   Stage::integrate};
  return std::find(std::begin(later), std::end(later), stage) != std::end(later);
}

} // namespace

UsedPart part_in_use(Buffer buffer, size_t bytes, const ItemsInUse &items)
{
  if (index_of(buffer) >= buffer_count) return {bytes, 1};
  const BufferRow &row = row_of(buffer);
  const size_t item = elements_of_item(buffer, items.features) * size_of(row.element), bodies = items.bodies;
  if (has_rows_of_bodies(buffer)) return {std::min(bytes, (bodies + 1) * item), 1};
  if (!items.pairs) return {bytes, 1};
  const size_t planes = planes_of(buffer, items.features), pairs = *items.pairs;
  if (is_sorted_list(buffer)) return {std::min(bytes, std::max(2 * bodies, pairs) * item), 1};
  if (planes == 0) return {bytes, 1};
  return {std::min(bytes / planes, pairs * (item / planes)), planes};
}

void StepParts::begin_step(uint32_t bodies, uint32_t cached_pairs, Features features)
{
  bodies_ = bodies;
  features_ = features;
  cached_pairs_ = cached_pairs;
}

void StepParts::begin_launch(const Launch &launch)
{
  pairs_are_found_ = comes_after_pairs(row_of(launch.kernel).stage);
  pairs_.reset();
}

/* Entries of counts that bound rows of pairs; the counts are read where they are valid, after all launches so far. */
uint32_t StepParts::pairs()
{
  if (pairs_) return *pairs_;
  std::array<uint32_t, COUNT_TOTAL> counts{};
  memory_.download(Buffer::counts, counts.data(), sizeof counts);
  pairs_ = std::max({cached_pairs_, counts[COUNT_PAIRS], counts[COUNT_PAIRS_NEEDED], counts[COUNT_BODY_PAIRS],
                     counts[COUNT_CONSTRAINTS], counts[COUNT_COMMIT_PAIRS], counts[COUNT_COMMIT_CONSTRAINTS]});
  return *pairs_;
}

UsedPart StepParts::part_of(Buffer buffer)
{
  const bool by_pairs = pairs_are_found_ && (planes_of(buffer, features_) > 0 || is_sorted_list(buffer));
  return part_in_use(buffer, memory_.bytes(buffer),
                     {bodies_, by_pairs ? std::optional(pairs()) : std::nullopt, features_});
}

} // namespace tandem
