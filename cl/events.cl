/* events.cl - entries: which pairs touch, and what the user is told of it. */
#include "cl/entry.h"
#include "shared/events/impulses.h"
#include "shared/events/pair_events.h"

ENTRIES(events)
