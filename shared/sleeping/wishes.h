/* wishes.h - which bodies take many substeps: those of islands of which some body has wished for them; see
 * substep_classes.h.
 *
 * A body wishes because of what it bears (load_rate.h), and goes on for as many steps as a world whose loads have gone
 * takes to come back to the fewest substeps (host/pipeline/substep_choice.h). If a body wished that took few, the step
 * runs again.
 */
#ifndef TANDEM_SHARED_SLEEPING_WISHES_H
#define TANDEM_SHARED_SLEEPING_WISHES_H

#include "shared/sleeping/islands.h"
#include "shared/substep_classes.h"

/* As hook_islands, before there are constraints. */
SHARED void hook_pairs_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *pair_color,
                            GLOBAL const uint *body_flags, GLOBAL const uint *island_label, GLOBAL uint *island_next,
                            GLOBAL uint *counts, uint round, uint i)
{
  if (pair_color[i] == COLOR_INACTIVE) return;
  hook_bodies(body_flags, island_label, island_next, counts, round, pair_a[i], pair_b[i]);
}

/* island_wishes: is 0 before. */
SHARED void gather_wishes_item(GLOBAL const uint *body_flags, GLOBAL const uint *body_wish,
                               GLOBAL const uint *cached_wish, GLOBAL const uint *island_label,
                               GLOBAL uint *island_wishes, uint i)
{
  if (is_dynamic(body_flags, i) && (body_wish[i] | cached_wish[i]) != 0u)
    ATOMIC_OR(island_wishes + island_label[i], 1u);
}

/* Kinematic bodies move as the few do. */
SHARED void class_bodies_item(GLOBAL const uint *body_flags, GLOBAL const uint *island_label,
                              GLOBAL const uint *island_wishes, GLOBAL uint *body_class, GLOBAL uint *counts, uint i)
{
  uint own = !is_dynamic(body_flags, i) ? NO_CLASS : island_wishes[island_label[i]] ? MANY_SUBSTEPS : FEW_SUBSTEPS;
  body_class[i] = own;
  if (own == MANY_SUBSTEPS) ATOMIC_ADD(counts + COUNT_MANY_BODIES, 1u);
  if (own != NO_CLASS) ATOMIC_OR(counts + COUNT_SUBSTEP_CLASSES, own);
  else if (body_type_of(body_flags[i]) == (uint)BODY_TYPE_KINEMATIC)
    ATOMIC_OR(counts + COUNT_SUBSTEP_CLASSES, FEW_SUBSTEPS);
}

/* steps: for which a wish holds. */
SHARED void keep_wishes_item(GLOBAL const uint *body_class, GLOBAL const uint *body_wish,
                             GLOBAL const uint *cached_wish, GLOBAL uint *kept_wish, GLOBAL uint *counts, uint steps,
                             uint i)
{
  uint left = cached_wish[i] != 0u ? cached_wish[i] - 1u : 0u;
  if (body_wish[i] != 0u) {
    left = steps;
    if (body_class[i] == FEW_SUBSTEPS) ATOMIC_OR(counts + COUNT_LATE_WISHES, 1u);
  }
  kept_wish[i] = left;
}

#endif
