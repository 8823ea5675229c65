/* limits.h - the numbers of rounds of the batchers, for kernels and for the host that launches them. */
#ifndef TANDEM_SHARED_BATCHING_LIMITS_H
#define TANDEM_SHARED_BATCHING_LIMITS_H

#include "shared/platform.h"

/* The first colours, of which contacts keep theirs whatever else is free. */
#define KEPT_COLORS 8u

/* Iterative batching: the rounds that fill one batch. */
#define BATCH_ROUNDS 4u

/* Two-stage batching: cells of one class, by the parity of their three numbers, are never neighbours. */
#define CELL_CLASSES 8u
/* The rounds within a cell. The rounds after the cells colour the contacts that these leave. */
#define CELL_ROUNDS 24u

#endif
