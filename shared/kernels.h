/* kernels.h - every shared kernel, in pipeline order. */
#ifndef TANDEM_SHARED_KERNELS_H
#define TANDEM_SHARED_KERNELS_H

#include "shared/lanes_kernels.h"
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
#include "shared/broadphase/brute_force.h"
#include "shared/broadphase/grid.h"
#include "shared/broadphase/sweep.h"
#include "shared/batching/cells.h"
#include "shared/batching/check.h"
#include "shared/batching/coloring.h"
#include "shared/batching/incidence.h"
#include "shared/batching/iterative.h"
#include "shared/batching/order.h"
#include "shared/batching/single_group.h"
#include "shared/solve/mass_split_sum.h"
#include "shared/solve/tail.h"
#include "shared/solve/pgs_tail.h"
#include "shared/solve/nncg_tail.h"
#include "shared/solve/rolling_tail.h"
#include "shared/problem/residual.h"
#include "shared/problem/sweep.h"

#endif
