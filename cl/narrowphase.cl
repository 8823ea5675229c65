/* narrowphase.cl - entries of the pair types in shared/narrowphase. */
#include "cl/entry.h"
#include "shared/narrowphase/kernels.h"

ENTRIES(narrowphase)
