/* limits.h - how many rounds the batchers take: known to kernels and to the host that launches them. */
#ifndef TANDEM_SHARED_BATCHING_LIMITS_H
#define TANDEM_SHARED_BATCHING_LIMITS_H

#include "shared/platform.h"

/* Iterative batching: rounds that fill one batch. */
#define BATCH_ROUNDS 4u

/* Two-stage batching: cells of one class, by the parity of their three numbers, are never neighbours. */
#define CELL_CLASSES 8u
/* Rounds within a cell; what they leave goes to the rounds after it. */
#define CELL_ROUNDS 24u

#endif
