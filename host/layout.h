/* layout.h - how many bytes each buffer takes for a given scene and its present capacities. */
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/kernel_list.h"
#include "host/settings.h"

namespace tandem {

struct Sizes {
  uint32_t bodies = 0;
  uint32_t materials = 0;
  uint32_t pairs = 0; /* capacity */
  uint32_t cells = 0; /* capacity */
  uint32_t features = 0;
  bool grid = false;
  bool sweep = false;
  bool two_stage = false; /* batching by cells */
  bool check = false;     /* batches are proven */
};

/* 0 for a buffer that the scene and settings do not need. */
size_t bytes_of(Buffer buffer, const Sizes &sizes);

/* Cells of the uniform grid: about two a body, so that the table costs little and cells hold few. */
uint32_t cells_for(uint32_t bodies);

} // namespace tandem
