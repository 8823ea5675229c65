/* events.cl - entries: which pairs touch, and what the user is told of it. */
#include "cl/entry.h"
#include "shared/events/kernels.h"

ENTRIES(events)
