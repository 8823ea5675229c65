/* problem.cl - entries: frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/pass.h"
#include "shared/problem/residual.h"

ENTRIES(problem)
