/* batching.cl - OpenCL entries of the batchers: matching with the last step, colouring, and the check of the
 * batches. */
#include "cl/entry.h"
#include "shared/batching/kernels.h"

ENTRIES(batching)
