/* setup.cl - entries: contact constraints. */
#include "cl/entry.h"
#include "shared/setup/kernels.h"

ENTRIES(setup)
