/* lanes_kernels.h - the shared kernels that are written for any width (LANES in kernels.def): all of them, or those of
 * one part of minicl/width.inc. */
#ifndef TANDEM_SHARED_LANES_KERNELS_H
#define TANDEM_SHARED_LANES_KERNELS_H

#include "shared/records.h"
#ifndef TANDEM_PART_SOLVING
#include "shared/broadphase/bounds.h"
#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/sphere_sphere.h"
#endif
#ifndef TANDEM_PART_FINDING
#include "shared/setup/contact.h"
#include "shared/setup/rolling.h"
#include "shared/solve/contact.h"
#include "shared/solve/xpbd.h"
#include "shared/solve/avbd.h"
#include "shared/solve/mass_split.h"
#include "shared/solve/pgs.h"
#include "shared/solve/nncg.h"
#include "shared/solve/rolling.h"
#include "shared/integrate/prepare.h"
#include "shared/integrate/velocities.h"
#include "shared/integrate/positions.h"
#include "shared/integrate/commit.h"
#include "shared/integrate/cache_rolling.h"
#include "shared/integrate/stop_at_time_of_impact.h"
#include "shared/events/impulses.h"
#endif

#endif
