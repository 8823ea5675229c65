/* kernels.h - the setup of contact constraints.
 *
 * cl/setup.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_SETUP_KERNELS_H
#define TANDEM_SHARED_SETUP_KERNELS_H

#include "shared/setup/contact.h"
#include "shared/setup/rolling.h"
#include "shared/setup/standing.h"

#endif
