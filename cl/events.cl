/* events.cl - OpenCL entries of the events: which pairs touch, and the list that the user reads. */
#include "cl/entry.h"
#include "shared/events/kernels.h"

ENTRIES(events)
