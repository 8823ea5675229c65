/* queries.cl - OpenCL entries of the queries between steps: rays and boxes against all bodies. */
#include "cl/entry.h"
#include "shared/queries/box_queries.h"
#include "shared/queries/cast_rays.h"

ENTRIES(queries)
