/* commands.cl - OpenCL entries of the calls that a program makes between two steps. */
#include "cl/entry.h"
#include "shared/commands/kernels.h"

ENTRIES(commands)
