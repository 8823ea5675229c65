/* kernels.h - rays and boxes against all bodies, and closest points of pairs, between steps.
 *
 * cl/queries.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_QUERIES_KERNELS_H
#define TANDEM_SHARED_QUERIES_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/queries/box_queries.h"
#include "shared/queries/cast_rays.h"
#include "shared/queries/closest_points.h"
#endif

#endif
