/* random_boxes.h - runs broadphases on boxes alone, without bodies, shapes or solver, at any coordinates. */
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/base/random.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "host/pipeline/scene_counts.h"
#include "host/scene/parameters.h"
#include "shared/body_codes.h"
#include "shared/features.h"
#include "shared/platform.h"
#include "tests/catch.h"

namespace tandem {

/* The boxes in the order of the body buffers: half-spaces first, then those called large. */
struct RandomBoxes {
  std::vector<float4> bounds; /* 2 a body */
  std::vector<uint32_t> flags, filters;
  uint32_t unbounded = 0, large = 0;
  float hybrid_cell = 1;

  uint32_t size() const { return static_cast<uint32_t>(flags.size()); }
  void add(const Vec3 &low, const Vec3 &high, uint32_t motion = BODY_TYPE_DYNAMIC, uint32_t group = 1,
           uint32_t mask = 0xffffffffu)
  {
    bounds.push_back({low[0], low[1], low[2], 0});
    bounds.push_back({high[0], high[1], high[2], 0});
    flags.push_back(SHAPE_BOX | motion << 3);
    filters.insert(filters.end(), {group, mask});
  }
  void add_half_space()
  {
    add({-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}, BODY_TYPE_FIXED);
    flags.back() = SHAPE_HALF_SPACE | BODY_TYPE_FIXED << 3;
    large = ++unbounded;
  }
};

using BodyPairs = std::vector<std::pair<uint32_t, uint32_t>>; /* (a, b), a > b, sorted */

/* The oracle: a sweep along x on the host, with the rules for pairs written out once more. */
inline BodyPairs expected_pairs(const RandomBoxes &boxes)
{
  const auto low = [&](uint32_t i) -> const float4 & { return boxes.bounds[2 * i]; };
  const auto high = [&](uint32_t i) -> const float4 & { return boxes.bounds[2 * i + 1]; };
  const auto moves = [&](uint32_t i) { return (boxes.flags[i] >> 3 & 3u) == BODY_TYPE_DYNAMIC; };
  const auto accepts = [&](uint32_t i, uint32_t j) { return (boxes.filters[2 * i] & boxes.filters[2 * j + 1]) != 0; };
  std::vector<uint32_t> order(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t i, uint32_t j) { return low(i).x < low(j).x; });
  BodyPairs pairs;
  for (size_t p = 0; p < order.size(); ++p)
    for (size_t q = p + 1; q < order.size() && low(order[q]).x <= high(order[p]).x; ++q) {
      const uint32_t i = order[p], j = order[q];
      const bool apart = low(i).y > high(j).y || low(j).y > high(i).y || low(i).z > high(j).z || low(j).z > high(i).z;
      if (!apart && (moves(i) || moves(j)) && accepts(i, j) && accepts(j, i))
        pairs.emplace_back(std::max(i, j), std::min(i, j));
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/* One backend with the buffers of a broadphase. The pair capacity grows as World's does, by the number needed. */
class BroadphaseRunner {
public:
  explicit BroadphaseRunner(std::unique_ptr<Backend> backend)
      : backend_(std::move(backend)), launcher_(memory_, *backend_)
  {
    std::vector<Kernel> kernels;
    for (size_t k = 0; k < kernel_count; ++k)
      if (const Stage stage = row_of(kernel_at(k)).stage; stage == Stage::parallel || stage == Stage::broadphase)
        kernels.push_back(kernel_at(k));
    backend_->prepare(FEATURE_FILTER, kernels);
  }
  ~BroadphaseRunner() { backend_->finish(); }

  const std::string &name() const { return backend_->name(); }

  void take(const RandomBoxes &boxes)
  {
    plan_.bodies = boxes.size();
    plan_.capacity_cells = cells_for(boxes.size());
    plan_.features = FEATURE_FILTER;
    counts_.fill(0);
    last_.clear();
    for (const auto &[entry, value] : entries_of({boxes.size(), boxes.unbounded, boxes.large})) counts_[entry] = value;
    counts_[CAPACITY_CELLS] = plan_.capacity_cells;
    reserve(1000, 1000);
    Parameters parameters{};
    parameters.hybrid_cell = boxes.hybrid_cell;
    parameters.step = 1;
    parameters.features = FEATURE_FILTER;
    memory_.upload(Buffer::parameters, &parameters, sizeof parameters);
    memory_.upload(Buffer::bounds, boxes.bounds.data(), boxes.bounds.size() * sizeof(float4));
    memory_.upload(Buffer::body_flags, boxes.flags.data(), boxes.flags.size() * sizeof(uint32_t));
    memory_.upload(Buffer::body_filter, boxes.filters.data(), boxes.filters.size() * sizeof(uint32_t));
  }

  /* Moves the same bodies a step later; the data that a broadphase keeps stay. velocities: 2 rows for each body, m in a
   * step; none: all are at rest. */
  void move_to(const RandomBoxes &boxes, const std::vector<float4> &velocities = {})
  {
    memory_.upload(Buffer::bounds, boxes.bounds.data(), boxes.bounds.size() * sizeof(float4));
    if (!velocities.empty())
      memory_.upload(Buffer::body_velocity, velocities.data(), velocities.size() * sizeof(float4));
  }

  /* Does what a query between two steps does. */
  void make_query_hierarchy() { build_hierarchy(step_, false); }

  /* Finds the pairs. All broadphases share the buffers of kept data, so these are dropped when another one runs. */
  BodyPairs find(const BroadphaseRow &broadphase)
  {
    if (last_ != broadphase.name) forget_kept(memory_);
    last_ = broadphase.name;
    for (;;) {
      broadphase.launch(step_);
      const auto after = memory_.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
      const uint32_t needed = after[COUNT_PAIRS_NEEDED], candidates = after[COUNT_CANDIDATES_NEEDED];
      if (needed > plan_.capacity_pairs || candidates > plan_.capacity_candidates) {
        if (needed > plan_.capacity_pairs) check_clamped(after[COUNT_PAIRS], broadphase);
        reserve(std::max(plan_.capacity_pairs, needed), std::max(plan_.capacity_candidates, candidates));
        continue;
      }
      check_starts(after[COUNT_PAIRS]);
      return pairs(after[COUNT_PAIRS]);
    }
  }

private:
  void reserve(uint32_t pairs, uint32_t candidates)
  {
    plan_.capacity_pairs = counts_[CAPACITY_PAIRS] = pairs;
    plan_.capacity_candidates = counts_[CAPACITY_CANDIDATES] = candidates;
    const Sizes sizes{.bodies = plan_.bodies,
                      .materials = 1,
                      .hulls = {},
                      .trees = {},
                      .pairs = pairs,
                      .cells = plan_.capacity_cells,
                      .candidates = candidates,
                      .features = FEATURE_FILTER};
    for (size_t b = 0; b < buffer_count; ++b) {
      const bool wanted = buffer_at(b) <= Buffer::pair_key_other;
      if (wanted) memory_.resize(buffer_at(b), bytes_of(buffer_at(b), sizes));
    }
    memory_.resize(Buffer::counts, sizeof counts_);
    memory_.upload(Buffer::counts, counts_.data(), sizeof counts_);
    plan_.known = counts_;
    plan_.known[COUNT_PAIRS] = pairs;
    plan_.known[COUNT_CELLS_PLUS_ONE] = plan_.capacity_cells + 1;
  }

  /* The pair list is full. A broadphase that keeps lists may have overflowed one of those instead. */
  void check_clamped(uint32_t pairs, const BroadphaseRow &broadphase)
  {
    const bool keeps_lists = broadphase.launch == find_pairs_incrementally || broadphase.launch == find_pairs_in_trees;
    if (keeps_lists) CHECK(pairs <= plan_.capacity_pairs);
    else CHECK(pairs == plan_.capacity_pairs);
  }

  BodyPairs pairs(uint32_t count)
  {
    const auto a = memory_.read<uint32_t>(Buffer::pair_a, count), b = memory_.read<uint32_t>(Buffer::pair_b, count);
    BodyPairs found;
    for (uint32_t k = 0; k < count; ++k) found.emplace_back(a[k], b[k]);
    return found;
  }

  void check_starts(uint32_t count)
  {
    const auto starts = memory_.read<uint32_t>(Buffer::pair_start, plan_.bodies + 1),
               owners = memory_.read<uint32_t>(Buffer::pair_a, count);
    bool right = starts.back() == count;
    for (uint32_t body = 0; body < plan_.bodies; ++body)
      for (uint32_t k = starts[body]; k < starts[body + 1] && k < count; ++k) right = right && owners[k] == body;
    CHECK(right);
  }

  std::unique_ptr<Backend> backend_;
  Memory memory_;
  DirectLauncher launcher_;
  StepPlan plan_;
  Settings settings_;
  std::string last_; /* the broadphase that ran last */
  StepLaunches step_{launcher_, plan_, settings_};
  std::array<uint32_t, COUNT_TOTAL> counts_{};
};

} // namespace tandem
