/* kernels.h - the kernels of every stage, or those of one part of minicl/width.inc. A width of several lanes has the
 * LANES, LANES_PADDED and LANES_GROUP kernels alone. */
#ifndef TANDEM_SHARED_KERNELS_H
#define TANDEM_SHARED_KERNELS_H

#include "shared/records.h"
#ifndef TANDEM_PART_SOLVING
#include "shared/parallel/kernels.h"
#include "shared/broadphase/kernels.h"
#include "shared/midphase/kernels.h"
#include "shared/narrowphase/kernels.h"
#include "shared/sleeping/kernels.h"
#include "shared/queries/kernels.h"
#include "shared/sweeps/kernels.h"
#endif
#ifndef TANDEM_PART_FINDING
#include "shared/commands/kernels.h"
#include "shared/setup/kernels.h"
#include "shared/batching/kernels.h"
#include "shared/joints/kernels.h"
#include "shared/solve/kernels.h"
#if !defined(TANDEM_LANES) || TANDEM_LANES >= 8 /* the widths of trees: minicl/width.inc */
#include "shared/articulations/kernels.h"
#endif
#include "shared/integrate/kernels.h"
#include "shared/forces/kernels.h"
#include "shared/events/kernels.h"
#include "shared/problem/kernels.h"
#endif

#endif
