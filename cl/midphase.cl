/* midphase.cl - OpenCL entries of shared/midphase. */
#include "cl/entry.h"
#include "shared/midphase/kernels.h"

ENTRIES(midphase)
