/* kernels.h - matching with the last step, the batchers, and the proof of their batches.
 *
 * cl/batching.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_BATCHING_KERNELS_H
#define TANDEM_SHARED_BATCHING_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/batching/body_coloring.h"
#include "shared/batching/body_constraints.h"
#include "shared/batching/cells.h"
#include "shared/batching/check.h"
#include "shared/batching/class_order.h"
#include "shared/batching/coloring.h"
#include "shared/batching/iterative.h"
#include "shared/batching/match.h"
#include "shared/batching/order.h"
#include "shared/batching/single_group.h"
#include "shared/batching/world_order.h"
#endif

#endif
