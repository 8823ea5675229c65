/* queries.cl - entries: rays and boxes against all bodies, between steps. */
#include "cl/entry.h"
#include "shared/queries/box_queries.h"
#include "shared/queries/cast_rays.h"

ENTRIES(queries)
