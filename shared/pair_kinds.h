/* pair_kinds.h - which kernel a pair is for: the one place that decides it, from the rows of pairs.def.
 *
 * The kinds of shapes alone tell, so the host asks the same function which kinds a scene can have
 * (host/scene/specialise.cpp), and narrowphase/pair_lists.h sorts pairs by it. */
#ifndef TANDEM_SHARED_PAIR_KINDS_H
#define TANDEM_SHARED_PAIR_KINDS_H

#include "shared/records.h"

/* Of two shapes as a set: the same whichever comes first. */
#define ONE_SHAPE(shape) (1u << (uint)(shape))

/* PAIR_KIND_ of two bodies; PAIR_KIND_NONE of two half-spaces, which have no test. */
SHARED uint_lanes pair_kind(uint_lanes flags_a, uint_lanes flags_b)
{
  uint_lanes shapes = ((uint_lanes)1u << shape_of(flags_a)) | ((uint_lanes)1u << shape_of(flags_b));
  uint_lanes kind = choose((shapes & ONE_SHAPE(SHAPE_HALF_SPACE)) != 0u, (uint_lanes)(uint)PAIR_KIND_CONVEX_HALF_SPACE,
                           (uint_lanes)(uint)PAIR_KIND_CONVEX_CONVEX);
  kind = choose(shapes == ONE_SHAPE(SHAPE_HALF_SPACE), (uint_lanes)(uint)PAIR_KIND_NONE, kind);
#define GENERAL_PAIR(name, first, second, kernel, follower, what)
#define PAIR(name, first, second, kernel, follower, what)                                                             \
  kind = choose(shapes == (ONE_SHAPE(SHAPE_##first) | ONE_SHAPE(SHAPE_##second)), (uint_lanes)(uint)PAIR_KIND_##name, \
                kind);
#include "shared/pairs.def"
#undef PAIR
#undef GENERAL_PAIR
  return kind;
}

#endif
