/* kernels.h - the midphase: leaves of meshes, subtrees and internal edges.
 *
 * cl/midphase.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_MIDPHASE_KERNELS_H
#define TANDEM_SHARED_MIDPHASE_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/midphase/internal_edges.h"
#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/subtree_pairs.h"
#endif

#endif
