/* integrate.cl - entries: bodies: forces, motion, and the end of a step. */
#include "cl/entry.h"
#include "shared/integrate/commit.h"
#include "shared/integrate/prepare.h"
#include "shared/integrate/velocities.h"
#include "shared/integrate/positions.h"
#include "shared/integrate/cache_rolling.h"
#include "shared/integrate/stop_motion.h"

ENTRIES(integrate)
