/* curve_limits.h - how fine the curve is, for the host too. */
#ifndef TANDEM_SHARED_BROADPHASE_CURVE_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_CURVE_LIMITS_H

#include "shared/platform.h"

/* Bits of a code: ten an axis. */
#define CURVE_BITS 30u
/* Of the curve along an axis. */
#define CURVE_CELLS (1 << CURVE_BITS / 3u)

#endif
