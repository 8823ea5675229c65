/* fill.h - fills a buffer with one value. It is the simplest kernel, and so the pattern of all others: a plain function
 * of one item here, and a row in kernels.def. */
#ifndef TANDEM_SHARED_PARALLEL_FILL_H
#define TANDEM_SHARED_PARALLEL_FILL_H

#include "shared/platform.h"

SHARED void fill_item(GLOBAL uint *values, uint value, uint i) { values[i] = value; }

#endif
