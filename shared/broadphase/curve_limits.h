/* curve_limits.h - the resolution of the curve, for kernels and the host. */
#ifndef TANDEM_SHARED_BROADPHASE_CURVE_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_CURVE_LIMITS_H

#include "shared/platform.h"

/* The bits of a code: ten for each axis. */
#define CURVE_BITS 30u
/* The cells of the curve along an axis. */
#define CURVE_CELLS (1 << CURVE_BITS / 3u)

#endif
