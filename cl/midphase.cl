/* midphase.cl - OpenCL entries of shared/midphase. */
#include "cl/entry.h"
#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/subtree_pairs.h"
#include "shared/midphase/internal_edges.h"

ENTRIES(midphase)
