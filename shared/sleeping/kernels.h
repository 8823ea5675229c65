/* kernels.h - islands that fall asleep, and what wakes them.
 *
 * cl/sleeping.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_SLEEPING_KERNELS_H
#define TANDEM_SHARED_SLEEPING_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/sleeping/awake_first.h"
#include "shared/sleeping/islands.h"
#include "shared/sleeping/near_sleepers.h"
#include "shared/sleeping/rest.h"
#include "shared/sleeping/sleeper_table.h"
#include "shared/sleeping/wishes.h"
#endif

#endif
