/* kernels.h - frictional contact problems.
 *
 * cl/problem.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_PROBLEM_KERNELS_H
#define TANDEM_SHARED_PROBLEM_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/problem/pass.h"
#include "shared/problem/residual.h"
#endif

#endif
