/* setup.cl - entries: contact constraints. */
#include "cl/entry.h"
#include "shared/setup/contact.h"
#include "shared/setup/rolling.h"

ENTRIES(setup)
