/* queries.cl - entries: rays and boxes against all bodies, between steps. */
#include "cl/entry.h"
#include "shared/queries/kernels.h"

ENTRIES(queries)
