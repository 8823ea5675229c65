/* kernel_table.h - every kernel of a module as a plain function over a range of items.
 *
 * There is one table for each width: scalar (one item at a time; also compiled for AVX2), backward (the kernels marked
 * GROUP or LANES_GROUP, with their phases run in reverse), and 4, 8 and 16 lanes for kernels marked LANES, LANES_PADDED
 * or LANES_GROUP.
 */
#pragma once

#include <cstdint>

#include "host/runtime/interface/module.h"

namespace tandem::minicl {

/* The table of a module in one width, which width.inc defines. */
struct KernelTable {
  uint32_t lanes;
  const RunRange *run; /* by kernel of the module; null, the array or an entry, if this width does not have it */
};

/* The tables of the pipeline. */

extern const KernelTable scalar_kernels;
extern const KernelTable scalar_avx2_kernels; /* the same, with AVX2 where the compiler has it */
extern const KernelTable backward_kernels;
extern const KernelTable reference_kernels; /* in double */
extern const KernelTable lanes4_kernels;
extern const KernelTable lanes8_kernels;
extern const KernelTable lanes16_kernels;

/* The most lanes that this processor can run: 4, or 8 / 16 if it has AVX2 / AVX-512. */
uint32_t widest_lanes();
/* The pipeline's table for 4, 8 or 16 lanes; null for width 1 or a width that this processor cannot run. */
const KernelTable *lanes_table(uint32_t lanes);

} // namespace tandem::minicl
