/* broadphase.cl - OpenCL entries of the bounds, and of the broadphases over them. */
#include "cl/entry.h"
#include "shared/broadphase/bounds.h"
#include "shared/broadphase/brute_force.h"
#include "shared/broadphase/candidate_pairs.h"
#include "shared/broadphase/extent.h"
#include "shared/broadphase/grid.h"
#include "shared/broadphase/grid_symmetric.h"
#include "shared/broadphase/hybrid.h"
#include "shared/broadphase/sap3.h"
#include "shared/broadphase/sweep_window.h"
#include "shared/broadphase/tight_bounds.h"

ENTRIES(broadphase)
