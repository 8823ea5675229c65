/* problem.cl - OpenCL entries of the frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/kernels.h"

ENTRIES(problem)
