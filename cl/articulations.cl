/* articulations.cl - OpenCL entries of articulations. */
#include "cl/entry.h"
#include "shared/articulations/kernels.h"

ENTRIES(articulations)
