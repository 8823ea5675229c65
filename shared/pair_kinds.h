/* pair_kinds.h - the kind of a pair, which selects its kernel, from the rows of pairs.def. This is the only place that
 * decides it.
 *
 * The shapes alone determine the kind. The host therefore calls the same function to find the kinds that a scene can
 * have (host/scene/specialise.cpp), and narrowphase/pair_lists.h sorts pairs by it. */
#ifndef TANDEM_SHARED_PAIR_KINDS_H
#define TANDEM_SHARED_PAIR_KINDS_H

#include "shared/records.h"

/* The set of the two shapes of a pair, which does not depend on their order. */
#define ONE_SHAPE(shape) (1u << (uint)(shape))

/* The PAIR_KIND_ of two bodies; PAIR_KIND_NONE for two half-spaces, which have no test. */
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
