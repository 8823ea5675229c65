/* near_limits.h - room for pairs of fat boxes, for the host too: more of them overlap than of bounds. */
#ifndef TANDEM_SHARED_BROADPHASE_NEAR_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_NEAR_LIMITS_H

#include "shared/platform.h"

#define NEAR_PER_PAIR 4u

#endif
