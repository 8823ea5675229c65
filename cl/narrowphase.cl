/* narrowphase.cl - OpenCL entries of the pair kernels in shared/narrowphase. */
#include "cl/entry.h"
#include "shared/narrowphase/kernels.h"

ENTRIES(narrowphase)
