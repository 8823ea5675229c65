/* kernels.h - bounds, and the broadphases over them.
 *
 * cl/broadphase.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_BROADPHASE_KERNELS_H
#define TANDEM_SHARED_BROADPHASE_KERNELS_H

#include "shared/broadphase/bounds.h"

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/broadphase/brute_force.h"
#include "shared/broadphase/candidate_pairs.h"
#include "shared/broadphase/extent.h"
#include "shared/broadphase/grid.h"
#include "shared/broadphase/grid_symmetric.h"
#include "shared/broadphase/hybrid.h"
#include "shared/broadphase/sap3.h"
#include "shared/broadphase/sweep_window.h"
#include "shared/broadphase/tight_bounds.h"
#endif

#endif
