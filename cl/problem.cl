/* problem.cl - OpenCL entries of the frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/pass.h"
#include "shared/problem/residual.h"

ENTRIES(problem)
