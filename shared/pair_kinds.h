/* pair_kinds.h - which kernel a pair is for: the one place that decides it, from the rows of pairs.def.
 *
 * The kinds of shapes alone tell, so the host asks the same function which kinds a scene can have
 * (host/scene/specialise.cpp), and narrowphase/pair_lists.h sorts pairs by it. */
#ifndef TANDEM_SHARED_PAIR_KINDS_H
#define TANDEM_SHARED_PAIR_KINDS_H

#include "shared/records.h"

SHARED mask are_shapes(natural a, natural b, uint first, uint second)
{
  return ((a == first) & (b == second)) | ((a == second) & (b == first));
}

/* PAIR_KIND_ of two bodies; PAIR_KIND_NONE of two half-spaces, which have no test. */
SHARED natural pair_kind(natural traits_a, natural traits_b)
{
  natural a = shape_of(traits_a), b = shape_of(traits_b);
  mask plane_a = a == (uint)SHAPE_HALF_SPACE, plane_b = b == (uint)SHAPE_HALF_SPACE;
  natural kind =
      choose(plane_a | plane_b, (natural)(uint)PAIR_KIND_CONVEX_HALF_SPACE, (natural)(uint)PAIR_KIND_CONVEX_CONVEX);
  kind = choose(plane_a & plane_b, (natural)(uint)PAIR_KIND_NONE, kind);
#define GENERAL_PAIR(name, first, second, kernel, follower, what)
#define PAIR(name, first, second, kernel, follower, what) \
  kind = choose(are_shapes(a, b, (uint)SHAPE_##first, (uint)SHAPE_##second), (natural)(uint)PAIR_KIND_##name, kind);
#include "shared/pairs.def"
#undef PAIR
#undef GENERAL_PAIR
  return kind;
}

#endif
