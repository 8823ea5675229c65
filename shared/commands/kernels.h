/* kernels.h - the calls of a program between two steps, applied to the bodies.
 *
 * cl/commands.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_COMMANDS_KERNELS_H
#define TANDEM_SHARED_COMMANDS_KERNELS_H

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/commands/apply_commands.h"
#include "shared/commands/reset_worlds.h"
#endif

#endif
