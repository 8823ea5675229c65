/* lanes_kernels.h - the shared kernels that are written at any width (LANES in kernels.def). */
#ifndef TANDEM_SHARED_LANES_KERNELS_H
#define TANDEM_SHARED_LANES_KERNELS_H

#include "shared/records.h"
#include "shared/broadphase/bounds.h"
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
#include "shared/events/impulses.h"
#include "shared/integrate/stop_motion.h"
#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/sphere_sphere.h"

#endif
