/* candidate_limits.h - capacity for pairs of fat boxes, for the host too: more of them overlap than of bounds. */
#ifndef TANDEM_SHARED_BROADPHASE_CANDIDATE_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_CANDIDATE_LIMITS_H

#include "shared/platform.h"

#define CANDIDATES_PER_PAIR 4u

#endif
