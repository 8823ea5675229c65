/* layout.h - how many bytes each buffer takes for a given scene and its present capacities. */
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
  uint32_t pairs = 0; /* capacity */
  uint32_t cells = 0; /* capacity */
  Features features = 0;
};

/* 0 for a buffer whose feature the scene lacks. */
size_t bytes_of(Buffer buffer, const Sizes &sizes);

/* InputError names a buffer whose elements 32 bits cannot number, as kernels do. */
void check_size(Buffer buffer, const Sizes &sizes);

/* Leaves of a hierarchy of so many bodies: a power of two. */
uint32_t leaves_for(uint32_t bodies);

/* Cells of the uniform grid: about two a body, so that the table costs little and cells hold few. */
uint32_t cells_for(uint32_t bodies);

} // namespace tandem
