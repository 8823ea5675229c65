/* events.cl - OpenCL entries of the events: which pairs touch, and the list that the user reads. */
#include "cl/entry.h"
#include "shared/events/impulses.h"
#include "shared/events/pair_events.h"

ENTRIES(events)
