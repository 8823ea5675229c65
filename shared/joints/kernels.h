/* kernels.h - joints between bodies.
 *
 * cl/joints.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_JOINTS_KERNELS_H
#define TANDEM_SHARED_JOINTS_KERNELS_H

#include "shared/joints/bounce.h"
#include "shared/joints/couplings.h"
#include "shared/joints/load_rate.h"
#include "shared/joints/mass_split.h"
#include "shared/joints/nncg.h"
#include "shared/joints/prepare.h"
#include "shared/joints/share_impulses.h"
#include "shared/joints/solve.h"
#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
#include "shared/joints/avbd.h"
#include "shared/joints/by_world.h"
#include "shared/joints/couplings_by_world.h"
#include "shared/joints/driven.h"
#include "shared/joints/loads.h"
#include "shared/joints/overflow.h"
#include "shared/joints/overflow_couplings.h"
#endif

#endif
