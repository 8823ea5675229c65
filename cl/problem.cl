/* problem.cl - entries: frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/residual.h"
#include "shared/problem/sweep.h"

ENTRIES(problem)
