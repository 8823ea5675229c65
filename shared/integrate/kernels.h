/* kernels.h - forces, motion, and the end of a step.
 *
 * cl/integrate.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_INTEGRATE_KERNELS_H
#define TANDEM_SHARED_INTEGRATE_KERNELS_H

#include "shared/integrate/cache_rolling.h"
#include "shared/integrate/clamp_speeds.h"
#include "shared/integrate/commit.h"
#include "shared/integrate/failed_bodies.h"
#include "shared/integrate/lock_bodies.h"
#include "shared/integrate/note_moved.h"
#include "shared/integrate/positions.h"
#include "shared/integrate/prepare.h"
#include "shared/integrate/stop_at_time_of_impact.h"
#include "shared/integrate/take_parameters.h"
#include "shared/integrate/velocities.h"

#endif
