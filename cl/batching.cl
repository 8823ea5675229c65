/* batching.cl - OpenCL entries of the batchers: matching with the last step, colouring, and the check of the
 * batches. */
#include "cl/entry.h"
#include "shared/batching/match.h"
#include "shared/batching/cells.h"
#include "shared/batching/check.h"
#include "shared/batching/coloring.h"
#include "shared/batching/body_constraints.h"
#include "shared/batching/body_coloring.h"
#include "shared/batching/iterative.h"
#include "shared/batching/order.h"
#include "shared/batching/single_group.h"

ENTRIES(batching)
