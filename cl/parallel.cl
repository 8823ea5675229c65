/* parallel.cl - OpenCL entries of the primitives in shared/parallel. */
#include "cl/entry.h"
#include "shared/parallel/kernels.h"

ENTRIES(parallel)
