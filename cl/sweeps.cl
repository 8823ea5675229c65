/* sweeps.cl - entries: a convex shape of any kind, also one that the scene lacks, on straight ways. */
#define ASKED_ABOUT_ANY_SHAPE
#include "cl/entry.h"
#include "shared/sweeps/kernels.h"

ENTRIES(sweeps)
