/* layout.h - the size of each buffer in bytes for a given scene and its present capacities. */
#pragma once

#include <cstddef>
#include <cstdint>

#include <tandem/settings.h>

#include "host/runtime/interface/kernel_list.h"
#include "host/scene/hull_buffers.h"
#include "host/scene/tree_tables.h"

namespace tandem {

struct Sizes {
  uint32_t bodies = 0;
  uint32_t materials = 0;
  HullSizes hulls;
  TreeSizes trees;
  uint32_t joints = 0;
  uint32_t joint_axes = 0; /* the most of one joint */
  uint32_t couplings = 0;
  uint32_t articulations = 0; /* with room for those that are missing beside others: host/scene/tree_places.h */
  uint32_t links = 0;         /* of all of these */
  size_t path_entries = 0;    /* of all of these that have tables of paths */
  uint32_t tree_freedoms = 0; /* the most of one of these */
  uint32_t joined_pairs = 0;  /* entries of their table */
  uint32_t pairs = 0;         /* capacity */
  uint32_t cells = 0;         /* capacity */
  uint32_t candidates = 0;    /* capacity; 0 without the broadphase trees */
  Features features = 0;
};

/* The size is 0 for a buffer whose feature the scene lacks. */
size_t bytes_of(Buffer buffer, const Sizes &sizes);

/* Throws InputError that names a buffer with more elements than kernels can index with 32 bits. */
void check_size(Buffer buffer, const Sizes &sizes);

/* The most contact points of a pair, each with planes of its own (shared/point_rows.h). */
uint32_t points_of_pair(Features features);
/* Elements of a buffer for each of its items; buffers.def counts the planes of all points that a pair can have. */
uint32_t elements_of_item(Buffer buffer, Features features);

/* The element of body_filter at which the table of joined pairs begins. */
uint32_t first_joined_pair(const Sizes &sizes);

/* The number of leaves of a hierarchy of so many bodies, a power of two. */
uint32_t leaves_for(uint32_t bodies);

/* The number of cells of the uniform grid: about two for each body, so that the table is small and cells hold few
 * bodies. */
uint32_t cells_for(uint32_t bodies);

} // namespace tandem
