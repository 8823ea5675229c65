/* solve.cl - entries: the contact solvers. */
#include "cl/entry.h"
#include "shared/solve/kernels.h"

ENTRIES(solve)
