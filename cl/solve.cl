/* solve.cl - OpenCL entries of the contact solvers. */
#include "cl/entry.h"
#include "shared/solve/kernels.h"

ENTRIES(solve)
