/* broadphase.cl - OpenCL entries of the bounds, and of the broadphases over them. */
#include "cl/entry.h"
#include "shared/broadphase/kernels.h"

ENTRIES(broadphase)
