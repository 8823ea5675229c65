/* load_rate.h - what loads need substeps for is noted as one number of the step: the square of the rate of substeps.
 *
 * Where a world chooses its substeps itself, contacts (setup/standing.h) and joints (joints/load_rate.h) note here what
 * they need, and a step whose substeps are too few is run again (integrate/commit.h, host/pipeline/substep_choice.h).
 * It is a maximum, so its order changes no bit.
 */
#ifndef TANDEM_SHARED_LOAD_RATE_H
#define TANDEM_SHARED_LOAD_RATE_H

#include "shared/counts.h"
#include "shared/parameters.h"
#include "shared/records.h"

/* The fewest substeps of a step, and the rate that contacts of 60 Hz, the softest, are the stiffest of. */
#define FEWEST_SUBSTEPS R(4.0)
#define SOFTEST_RATE R(300.0)
/* Above every rate that matters: what is beyond the range of floats needs the most substeps. */
#define HIGHEST_RATE R(1e30)
/* A world that allows no depth at all is judged by the depths that others allow. */
#define USUAL_SLOP R(0.005)
#define USUAL_SLOP_SHARE R(0.05)

SHARED real bearable_share(GLOBAL const Parameters *parameters)
{
  return parameters->slop_share > R(0.0) ? parameters->slop_share : USUAL_SLOP_SHARE;
}

/* m, what bodies of this size may give way by; a size of 0 is none. */
SHARED real bearable_way(GLOBAL const Parameters *parameters, real size)
{
  real slop = parameters->slop > R(0.0) ? parameters->slop : USUAL_SLOP;
  return choose(size > R(0.0), minimum(slop, bearable_share(parameters) * size), slop);
}

/* Rates that the fewest substeps have are not noted, so that few items meet at the maximum. Returns what is. */
SHARED mask note_rate(GLOBAL const Parameters *parameters, mask wanted, real rate, GLOBAL uint *counts)
{
  real fewest = minimum(FEWEST_SUBSTEPS / parameters->step, SOFTEST_RATE);
  mask noted = wanted & (rate > fewest * fewest);
  if (any_of(noted))
    atomic_max_if(noted, counts, (uint_lanes)(uint)COUNT_LOAD_RATE, real_bits(minimum(rate, HIGHEST_RATE)));
  return noted;
}

/* Bodies that bear what the fewest substeps do not wish for many (sleeping/wishes.h). noted: of note_rate. */
SHARED void note_wishes(GLOBAL const Parameters *parameters, mask noted, real rate, GLOBAL uint *body_wish,
                        uint_lanes a, uint_lanes b)
{
  mask wishes = noted & (minimum(rate, HIGHEST_RATE) > (real)parameters->few_rate);
  if (!any_of(wishes)) return;
  atomic_max_if(wishes, body_wish, a, (uint_lanes)1u);
  atomic_max_if(wishes, body_wish, b, (uint_lanes)1u);
}

#endif
