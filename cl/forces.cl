/* forces.cl - OpenCL entries of applied forces. */
#include "cl/entry.h"
#include "shared/forces/kernels.h"

ENTRIES(forces)
