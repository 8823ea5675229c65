/* kernels.h - forces that a program or a module applies to bodies.
 *
 * cl/forces.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_FORCES_KERNELS_H
#define TANDEM_SHARED_FORCES_KERNELS_H

#include "shared/forces/applied_forces.h"

#endif
