/* phase_limits.h - the sizes of a script of phases, for cl/phases.cl and for the host, which writes it. */
#ifndef TANDEM_SHARED_PARALLEL_PHASE_LIMITS_H
#define TANDEM_SHARED_PARALLEL_PHASE_LIMITS_H

#include "shared/platform.h"

/* A row of the script: which case, the first and the last entry of counts, and as many values as any launch has. */
#define PHASE_RANGE_AT 1u
#define PHASE_VALUES_AT 3u
#define PHASE_WORDS 11u
/* Rows of a script. With the local memory of any kernel, 32 KiB, they fit the 48 KiB that GPUs have. */
#define MOST_PHASES 64u

#endif
