/* sweep_limits.h - how the windowed sweep is cut: known to its kernels and to the host that launches them. */
#ifndef TANDEM_SHARED_BROADPHASE_SWEEP_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_SWEEP_LIMITS_H

#include "shared/platform.h"

#define SWEEP_BLOCK 128u  /* bodies of a group */
#define SWEEP_SHARES 4u   /* work-items a body */
#define SWEEP_WINDOW 256u /* boxes in local memory, six planes of numbers */

#endif
