/* layout.cpp - computes the sizes of buffers from the capacities that buffers.def names; see layout.h. */
#include "host/pipeline/layout.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/pipeline/primitives.h"
#include "host/runtime/interface/features.h"
#include "shared/articulations/joint_types.h"
#include "shared/broadphase/sweep_limits.h"
#include "shared/platform.h"
#include "shared/sleeping/table_limits.h"

namespace tandem {
namespace {

constexpr uint32_t most_points_of_pair = 4;

/* The ends of boxes, pairs, candidates, and two bodies of each pair. */
size_t most_keys_sorted(const Sizes &sizes)
{
  return 2 * std::max({size_t{sizes.bodies}, size_t{sizes.pairs}, (size_t{sizes.candidates} + 1) / 2});
}

/* As places_of_contacts in articulations/contact_rows.h has it. */
size_t contacts_of_trees(const Sizes &sizes)
{
  const size_t contacts = std::min(size_t{sizes.pairs}, size_t{TREE_COLORS} * sizes.articulations);
  return sizes.tree_freedoms == 0 ? 1 : std::max<size_t>(contacts, 1); /* without a table of paths, no tree has rows */
}

/* A capacity without a case here must not compile, whatever warnings are enabled. */
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
size_t items_of(Capacity capacity, const Sizes &sizes)
{
  /* The numbers of bodies, pairs and parts of a scene are below 2^32 each, and buffers have few elements for each of
   * them, so 64 bits suffice for all products here. */
  const size_t sortable = std::max(2 * size_t{sizes.bodies}, size_t{sizes.pairs}); /* the ends of boxes; pairs */
  const size_t most_sorted = most_keys_sorted(sizes);                              /* some have buffers of their own */
  switch (capacity) {
  case Capacity::NOTHING: return 0;
  case Capacity::ONE: return 1;
  case Capacity::MATERIALS: return sizes.materials;
  case Capacity::HULLS: return sizes.hulls.hulls;
  case Capacity::HULL_VERTICES: return sizes.hulls.vertices;
  case Capacity::HULL_FACES: return size_t{sizes.hulls.faces} + 1;
  case Capacity::HULL_CORNERS: return sizes.hulls.corners;
  case Capacity::HULL_EDGES: return sizes.hulls.edges;
  case Capacity::TREES: return sizes.trees.trees;
  case Capacity::TREE_NODES: return sizes.trees.nodes;
  case Capacity::TREE_LEAVES: return sizes.trees.leaves;
  case Capacity::TREE_SUBTREES: return sizes.trees.subtrees;
  case Capacity::MESH_VERTICES: return sizes.trees.vertices;
  case Capacity::MESH_TRIANGLES: return sizes.trees.triangles;
  case Capacity::SHAPES: return size_t{sizes.bodies} + sizes.trees.children;
  case Capacity::FILTERS: return size_t{sizes.bodies} + sizes.trees.children + sizes.joined_pairs;
  case Capacity::JOINTS: return sizes.joints;
  case Capacity::JOINT_AXES: return size_t{sizes.joints} * sizes.joint_axes;
  case Capacity::COUPLINGS: return sizes.couplings;
  case Capacity::ARTICULATIONS: return sizes.articulations;
  case Capacity::LINKS: return sizes.links;
  case Capacity::PATH_ENTRIES: return std::max<size_t>(sizes.path_entries, 1);
  case Capacity::HULL_CHUNKS: return sizes.hulls.chunk_float4s;
  case Capacity::HULL_LINKS: return sizes.hulls.links;
  case Capacity::BODIES: return sizes.bodies;
  case Capacity::BODIES_PLUS_ONE: return size_t{sizes.bodies} + 1;
  case Capacity::MOVED_ROWS: return std::max(sizes.bodies, sizes.joints);
  case Capacity::SLEEPERS: return size_t{sizes.bodies} + MOST_UNSORTED_SLEEPERS;
  case Capacity::PAIRS: return sizes.pairs;
  case Capacity::TREE_CONTACTS: return contacts_of_trees(sizes);
  case Capacity::TREE_CONTACT_FREEDOMS: return contacts_of_trees(sizes) * std::max(sizes.tree_freedoms, 1u);
  case Capacity::EVENTS: return 2 * size_t{sizes.pairs}; /* at most the pairs of this step and of the last */
  case Capacity::PAIRS_PLUS_ONE: return size_t{sizes.pairs} + 1;
  case Capacity::CELLS: return size_t{sizes.cells} + 1;
  case Capacity::LEAVES: return leaves_for(sizes.bodies);
  case Capacity::LEAF_TILES: return leaves_for(sizes.bodies) / TILE + 1;
  case Capacity::CANDIDATE_PAIRS: return sizes.candidates;
  case Capacity::TILES: return (size_t{sizes.bodies} + TILE) / TILE;
  case Capacity::SORTABLE: return sortable;
  case Capacity::SORT_HISTOGRAM: return histogram_words(most_sorted);
  case Capacity::SCAN_SUMS:
    return scan_sum_words(std::max({most_sorted, size_t{SWEEP_SHARES} * sizes.bodies, histogram_words(most_sorted)}) +
                          1);
  case Capacity::REDUCE_PARTIAL: return reduce_partial_words(sizes.pairs);
  }
  return 0;
}
#pragma GCC diagnostic pop

} // namespace

size_t bytes_of(Buffer buffer, const Sizes &sizes)
{
  const BufferRow &row = row_of(buffer);
  if (row.feature != 0 && (row.feature & sizes.features) == 0) return 0;
  return items_of(row.capacity, sizes) * elements_of_item(buffer, sizes.features) * size_of(row.element);
}

void check_size(Buffer buffer, const Sizes &sizes)
{
  const uint64_t elements = uint64_t{bytes_of(buffer, sizes)} / size_of(row_of(buffer).element),
                 most = uint64_t{1} << 32;
  if (elements > most)
    throw InputError(fmt::format("buffer {} would have {} elements, and kernels can number {}: fewer bodies, hulls, "
                                 "cells of cube maps or articulations are needed",
                                 row_of(buffer).name, elements, most));
}

uint32_t points_of_pair(Features features)
{
  return (features & FEATURE_SEVERAL_POINTS) != 0 ? most_points_of_pair : 1;
}

uint32_t elements_of_item(Buffer buffer, Features features)
{
  const uint32_t elements = row_of(buffer).per_item;
  const bool has_planes = buffer == Buffer::manifold_points || buffer == Buffer::constraint_points,
             ends_in_friction = buffer == Buffer::nncg_impulse || buffer == Buffer::nncg_direction;
  if (ends_in_friction && (features & FEATURE_FRICTION) == 0) return elements - 1;
  return has_planes ? elements / most_points_of_pair * points_of_pair(features) : elements;
}

uint32_t first_joined_pair(const Sizes &sizes) { return 2 * (sizes.bodies + sizes.trees.children); }

uint32_t leaves_for(uint32_t bodies) { return std::bit_ceil(std::max(bodies, 1u)); }

uint32_t cells_for(uint32_t bodies) { return std::max<uint32_t>(1024, std::bit_ceil(2 * std::min(bodies, 1u << 29))); }

} // namespace tandem
