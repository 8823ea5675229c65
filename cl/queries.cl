/* queries.cl - OpenCL entries of the queries between steps: rays and boxes against all bodies, closest points. */
#include "cl/entry.h"
#include "shared/queries/kernels.h"

ENTRIES(queries)
