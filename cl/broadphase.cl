/* broadphase.cl - entries: bounds, and the broadphases over them. */
#include "cl/entry.h"
#include "shared/broadphase/kernels.h"

ENTRIES(broadphase)
