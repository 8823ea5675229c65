/* midphase.cl - entries of shared/midphase. */
#include "cl/entry.h"
#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/subtree_pairs.h"
#include "shared/midphase/grazing.h"

ENTRIES(midphase)
