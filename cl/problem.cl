/* problem.cl - entries: frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/kernels.h"

ENTRIES(problem)
