/* integrate.cl - OpenCL entries of the bodies: forces, motion, and the end of a step. */
#include "cl/entry.h"
#include "shared/integrate/kernels.h"

ENTRIES(integrate)
