/* kernels.h - the events of a step: which pairs touch, and with which impulse.
 *
 * cl/events.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_EVENTS_KERNELS_H
#define TANDEM_SHARED_EVENTS_KERNELS_H

#include "shared/events/impulses.h"

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/events/pair_events.h"
#endif

#endif
