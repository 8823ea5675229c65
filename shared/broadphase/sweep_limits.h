/* sweep_limits.h - the sizes of the windowed sweep, for its kernels and for the host that launches them. */
#ifndef TANDEM_SHARED_BROADPHASE_SWEEP_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_SWEEP_LIMITS_H

#include "shared/platform.h"

#define SWEEP_BLOCK 128u  /* bodies of a group */
#define SWEEP_SHARES 4u   /* work-items for each body */
#define SWEEP_WINDOW 256u /* boxes in local memory, as six planes of numbers */

#endif
