/* kernels.h - every shared kernel, in pipeline order. */
#ifndef TANDEM_SHARED_KERNELS_H
#define TANDEM_SHARED_KERNELS_H

#include "shared/lanes_kernels.h"
#include "shared/parallel/fill.h"

#endif
