/* phase_limits.h - the layout of a script of phases, for cl/phases.cl and for the host, which writes it. */
#ifndef TANDEM_SHARED_PARALLEL_PHASE_LIMITS_H
#define TANDEM_SHARED_PARALLEL_PHASE_LIMITS_H

#include "shared/platform.h"

/* A row of the script: which case, the first and the last entry of counts, whether all groups of the launch take part
 * or the first alone, whether all meet afterwards, and as many values as any launch has. */
#define PHASE_RANGE_AT 1u
#define PHASE_GROUPS_AT 3u
#define PHASE_MEETING_AT 4u
#define PHASE_VALUES_AT 5u
#define PHASE_WORDS 13u
#define PHASE_OF_TEST 0xffffffffu
/* Rows of a script. With the local memory of any kernel, 32 KiB, they fit the 48 KiB that GPUs have. */
#define MOST_PHASES 64u

/* Where groups meet: how many arrived since the program was built, whether some did not come in time, and two places an
 * item for the test. */
#define ARRIVALS_COUNT 0u
#define ARRIVALS_DEADLOCK 1u
#define ARRIVALS_RING 2u

#endif
