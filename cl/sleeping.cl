/* sleeping.cl - OpenCL entries of islands and sleeping. */
#include "cl/entry.h"
#include "shared/sleeping/kernels.h"

ENTRIES(sleeping)
