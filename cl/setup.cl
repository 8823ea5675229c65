/* setup.cl - OpenCL entries of the setup of contact constraints. */
#include "cl/entry.h"
#include "shared/setup/kernels.h"

ENTRIES(setup)
