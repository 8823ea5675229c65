/* kernels.h - convex shapes cast against all bodies, and those that they overlap, between steps.
 *
 * cl/sweeps.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_SWEEPS_KERNELS_H
#define TANDEM_SHARED_SWEEPS_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/sweeps/cast_shapes.h"
#include "shared/sweeps/overlap_shapes.h"
#endif

#endif
