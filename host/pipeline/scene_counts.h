/* scene_counts.h - the entries of counts that follow from the scene alone. The host sets them once, and kernels never
 * change them. */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tandem {

class Memory;

struct SceneCounts {
  uint32_t bodies = 0;    /* that are awake */
  uint32_t unbounded = 0; /* half-spaces: the first bodies */
  uint32_t large = 0;     /* these, and the bodies after them that are too large for a grid */
  uint32_t sleepers = 0;  /* behind the bodies that are awake */
};

/* The entries of shared/counts.h with their values; a change of a world replaces them after its last allocation. */
using SceneEntries = std::array<std::pair<int, uint32_t>, 17>;
SceneEntries entries_of(const SceneCounts &scene);
/* The entries of joints. starts: of each colour, of the overflow joints, and the end (host/scene/joint_graph.h). */
std::vector<std::pair<int, uint32_t>> joint_entries_of(std::span<const uint32_t> starts);
/* The same of couplings. */
std::vector<std::pair<int, uint32_t>> coupling_entries_of(std::span<const uint32_t> starts);
/* Whether an entry is one of the scene's. */
bool is_told_by_scene(uint32_t entry);
void set_count(Memory &memory, uint32_t entry, uint32_t value);
/* Sets COUNT_LENGTH, by which launches run over a list that the host has made. */
void set_length(Memory &memory, uint32_t length);

} // namespace tandem
