/* setup.cl - OpenCL entries of the setup of contact constraints. */
#include "cl/entry.h"
#include "shared/setup/contact.h"
#include "shared/setup/rolling.h"

ENTRIES(setup)
