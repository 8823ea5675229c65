/* narrowphase.cl - OpenCL entries of the pair kernels in shared/narrowphase. */
#include "cl/entry.h"
#include "shared/narrowphase/sphere_sphere.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/collide_convex.h"
#include "shared/narrowphase/follow_boxes.h"
#include "shared/narrowphase/follow_convexes.h"
#include "shared/narrowphase/clamp_to_time_of_impact.h"
#include "shared/narrowphase/list_pairs.h"
#include "shared/narrowphase/sat_split.h"

ENTRIES(narrowphase)
