/* kernels.h - the narrowphase: a pair of shapes in, contact manifolds out.
 *
 * cl/narrowphase.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_NARROWPHASE_KERNELS_H
#define TANDEM_SHARED_NARROWPHASE_KERNELS_H

#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/box_capsule.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/capsule_half_space.h"
#include "shared/narrowphase/capsules.h"
#include "shared/narrowphase/far_pairs.h"
#include "shared/narrowphase/follow_box_capsules.h"
#include "shared/narrowphase/follow_boxes.h"
#include "shared/narrowphase/follow_capsules.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/sphere_sphere.h"

#ifndef TANDEM_LANES /* ITEM and GROUP kernels take one item at a time */
#include "shared/narrowphase/clamp_to_time_of_impact.h"
#include "shared/narrowphase/collide_convex.h"
#include "shared/narrowphase/follow_convexes.h"
#include "shared/narrowphase/list_pairs.h"
#include "shared/narrowphase/sat_split.h"
#endif

#endif
