/* sweeps.cl - OpenCL entries of shape casts and overlap tests: a convex shape, also of a kind that the scene lacks,
 * along straight paths or at rest. */
#define ASKED_ABOUT_ANY_SHAPE
#include "cl/entry.h"
#include "shared/sweeps/kernels.h"

ENTRIES(sweeps)
