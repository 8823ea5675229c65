/* solve.cl - OpenCL entries of the contact solvers. */
#include "cl/entry.h"
#include "shared/solve/contact.h"
#include "shared/solve/mass_split_sum.h"
#include "shared/solve/pgs.h"
#include "shared/solve/nncg.h"
#include "shared/solve/xpbd_overflow.h"
#include "shared/solve/avbd_bodies.h"
#include "shared/solve/rolling_overflow.h"

ENTRIES(solve)
