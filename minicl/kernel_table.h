/* kernel_table.h - every kernel of a module as a plain function over a range of items.
 *
 * One table per width: scalar (items one at a time; once more for AVX2), backward (the same, with the phases of
 * work-groups walked in reverse), and 4, 8 and 16 lanes for kernels marked LANES.
 */
#pragma once

#include <cstdint>

#include "host/runtime/interface/module.h"

namespace tandem::minicl {

/* width.inc makes one of a module and a width. */
struct KernelTable {
  uint32_t lanes;
  const RunRange *run; /* by row; null, the whole or one: this width does not have it */
};

/* The pipeline's. */

extern const KernelTable scalar_kernels;
extern const KernelTable scalar_avx2_kernels; /* the same, with AVX2 where the compiler has it */
extern const KernelTable backward_kernels;
extern const KernelTable reference_kernels; /* in double */
extern const KernelTable lanes4_kernels;
extern const KernelTable lanes8_kernels;
extern const KernelTable lanes16_kernels;

/* The widths this processor can run: 1, 4 and, where it has AVX2 / AVX-512, 8 / 16. */
uint32_t widest_lanes();
/* The pipeline's table of 4, 8 or 16 lanes; null for width 1 or one this processor cannot run. */
const KernelTable *lanes_table(uint32_t lanes);

} // namespace tandem::minicl
