/* batching.cl - entries: matching with the last step, the batchers, and the proof of their batches. */
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
