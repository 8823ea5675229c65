/* lanes_kernels.h - the shared kernels that are written at any width (LANES in kernels.def). */
#ifndef TANDEM_SHARED_LANES_KERNELS_H
#define TANDEM_SHARED_LANES_KERNELS_H

#include "shared/counts.h"
#include "shared/features.h"
#include "shared/parameters.h"
#include "shared/math.h"
#include "shared/records.h"
#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/sphere_sphere.h"

#endif
