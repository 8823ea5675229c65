/* kernels.h - the contact solvers.
 *
 * cl/solve.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_SOLVE_KERNELS_H
#define TANDEM_SHARED_SOLVE_KERNELS_H

#include "shared/solve/avbd.h"
#include "shared/solve/mass_split.h"
#include "shared/solve/nncg.h"
#include "shared/solve/pgs.h"
#include "shared/solve/rolling.h"
#include "shared/solve/share_impulses.h"
#include "shared/solve/soft_step.h"
#include "shared/solve/xpbd.h"

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/solve/avbd_bodies.h"
#include "shared/solve/mass_split_sum.h"
#include "shared/solve/rolling_overflow.h"
#include "shared/solve/xpbd_overflow.h"
#endif

#endif
