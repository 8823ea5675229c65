/* parallel.cl - OpenCL entries of the primitives in shared/parallel. */
#include "cl/entry.h"
#include "shared/parallel/bitonic_sort.h"
#include "shared/parallel/compact.h"
#include "shared/parallel/copy.h"
#include "shared/parallel/fill.h"
#include "shared/parallel/flip_float.h"
#include "shared/parallel/move.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/reduce.h"
#include "shared/parallel/scan.h"
#include "shared/parallel/search.h"

ENTRIES(parallel)
