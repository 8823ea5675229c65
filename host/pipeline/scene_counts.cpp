/* scene_counts.cpp - the entries of counts and their values; see scene_counts.h. */
#include "host/pipeline/scene_counts.h"

#include <algorithm>

#include "host/pipeline/batching/batcher.h"
#include "host/pipeline/layout.h"
#include "host/runtime/memory.h"
#include "shared/broadphase/sweep_limits.h"
#include "shared/counts.h"
#include "shared/platform.h"

namespace tandem {

SceneEntries entries_of(const SceneCounts &scene)
{
  const uint32_t blocks = (scene.bodies + SWEEP_BLOCK - 1) / SWEEP_BLOCK;
  return {{{COUNT_ZERO, 0},
           {COUNT_ONE, 1},
           {COUNT_BODIES, scene.bodies},
           {COUNT_BODIES_PLUS_ONE, scene.bodies + 1},
           {COUNT_UNBOUNDED, scene.unbounded},
           {COUNT_BOUNDED, scene.bodies - scene.unbounded},
           {COUNT_LARGE, scene.large},
           {COUNT_SMALL, scene.bodies - scene.large},
           {COUNT_ALL_BODIES, scene.bodies + scene.sleepers},
           {COUNT_SLEEPERS, scene.sleepers},
           {COUNT_SHARES, SWEEP_SHARES * scene.bodies},
           {COUNT_SWEEP_BLOCKS, blocks},
           {COUNT_SWEEP_ITEMS, TILE * blocks},
           {COUNT_HALVES, 2 * scene.bodies},
           {COUNT_COLOR_STARTS, COLOR_LIMIT + 1},
           {COUNT_BATCH_CELLS, batch_cells_for(scene.bodies)},
           {COUNT_BATCH_ITEMS, TILE * batch_cells_for(scene.bodies)}}};
}

namespace {

std::vector<std::pair<int, uint32_t>> entries_by_color(int total, int first, std::span<const uint32_t> starts)
{
  std::vector<std::pair<int, uint32_t>> entries{{total, starts.back()}};
  for (size_t color = 0; color < starts.size(); ++color)
    entries.emplace_back(first + static_cast<int>(color), starts[color]);
  return entries;
}

} // namespace

std::vector<std::pair<int, uint32_t>> joint_entries_of(std::span<const uint32_t> starts)
{
  return entries_by_color(COUNT_JOINTS, JOINT_COLOR_START, starts);
}

std::vector<std::pair<int, uint32_t>> coupling_entries_of(std::span<const uint32_t> starts)
{
  return entries_by_color(COUNT_COUPLINGS, COUPLING_COLOR_START, starts);
}

void set_count(Memory &memory, uint32_t entry, uint32_t value)
{
  memory.upload(Buffer::counts, &value, sizeof value, entry * sizeof value);
}

void set_length(Memory &memory, uint32_t length) { set_count(memory, COUNT_LENGTH, length); }

bool is_told_by_scene(uint32_t entry)
{
  static const SceneEntries entries = entries_of({});
  return std::any_of(entries.begin(), entries.end(), [entry](const auto &one) { return uint32_t(one.first) == entry; });
}

} // namespace tandem
