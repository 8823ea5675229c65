/* integrate.cl - OpenCL entries of the bodies: forces, motion, and the end of a step. */
#include "cl/entry.h"
#include "shared/integrate/commit.h"
#include "shared/integrate/prepare.h"
#include "shared/integrate/velocities.h"
#include "shared/integrate/positions.h"
#include "shared/integrate/cache_rolling.h"
#include "shared/integrate/stop_at_time_of_impact.h"

ENTRIES(integrate)
