/* batching.cl - entries: matching with the last step, the batchers, and the proof of their batches. */
#include "cl/entry.h"
#include "shared/batching/kernels.h"

ENTRIES(batching)
