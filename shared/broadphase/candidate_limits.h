/* candidate_limits.h - the capacity for pairs of fat boxes, of which more overlap than of bounds; for the host, too. */
#ifndef TANDEM_SHARED_BROADPHASE_CANDIDATE_LIMITS_H
#define TANDEM_SHARED_BROADPHASE_CANDIDATE_LIMITS_H

#include "shared/platform.h"

#define CANDIDATES_PER_PAIR 4u

#endif
