/* avbd_penalties.h - the penalties of augmented vertex block descent, of contacts (avbd.h) and of joints
 * (joints/avbd.h): how large they are, what they keep from step to step, and how they grow. */
#ifndef TANDEM_SHARED_SOLVE_AVBD_PENALTIES_H
#define TANDEM_SHARED_SOLVE_AVBD_PENALTIES_H

#include "shared/math.h"

#define AVBD_ALPHA R(0.95)        /* share of a violation that is left in place */
#define AVBD_GAMMA R(0.99)        /* what those of contacts keep from one step to the next */
#define AVBD_BETA R(30.0)         /* s/m, growth of a penalty in units of the effective mass */
#define AVBD_FIRST_PENALTY R(1.0) /* of a new row, in units of the effective mass */
#define AVBD_FREE_PENALTY R(2.0)  /* up to this a penalty grows freely */
#define AVBD_GROWTH R(1.04)       /* beyond it, the largest growth in an iteration */
#define AVBD_LAST_PENALTY R(1e4)

/* The share of a force of this size that a limit leaves. */
SHARED real share_within(real size, real limit)
{
  mask beyond = size > limit;
  return choose(beyond, limit / choose(beyond, size, (real)R(1.0)), (real)R(1.0));
}

SHARED real kept_penalty(real mass, real old, real kept)
{
  return choose(mass > R(0.0), clamped(kept * old, AVBD_FIRST_PENALTY * mass, AVBD_LAST_PENALTY * mass), (real)R(0.0));
}

SHARED real grown_penalty(real penalty, real mass, real violation, mask holds)
{
  real limit = minimum(maximum(AVBD_GROWTH * penalty, AVBD_FREE_PENALTY * mass), AVBD_LAST_PENALTY * mass);
  real grown = minimum(penalty + AVBD_BETA * mass * magnitude(violation), limit);
  return choose(holds, grown, penalty);
}

#endif
