/* kernels.h - the primitives that sort, scan and reduce.
 *
 * cl/parallel.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_PARALLEL_KERNELS_H
#define TANDEM_SHARED_PARALLEL_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/parallel/bitonic_sort.h"
#include "shared/parallel/compact.h"
#include "shared/parallel/copy.h"
#include "shared/parallel/fill.h"
#include "shared/parallel/flip_float.h"
#include "shared/parallel/move.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/reduce.h"
#include "shared/parallel/rows.h"
#include "shared/parallel/scan.h"
#include "shared/parallel/search.h"
#endif

#endif
