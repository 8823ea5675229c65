/* substep.h - a substep of a tree that touches nothing, in the order of the solver soft-step.
 *
 *   accelerate (loads.h)  ->  rows, biased  ->  move (free_motion.h)  ->  rows, relaxing
 *
 * The tree is prepared (free_motion.h) where it stands; at the end it is again.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_SUBSTEP_H
#define TANDEM_SHARED_ARTICULATIONS_SUBSTEP_H

#include "shared/articulations/free_motion.h"
#include "shared/articulations/rows.h"

/* has_rows: whether any tree of the launch has a row. */
SHARED void advance_tree(GLOBAL const Parameters *parameters, const articulation *t, vec3 gravity, uint has_rows)
{
  accelerate_tree(t, gravity, parameters->substep);
  if (has_rows != 0u) solve_tree_rows(parameters, t, PASS_BIASED);
  move_tree_freely(t, parameters->substep);
  if (has_rows != 0u) solve_tree_rows(parameters, t, PASS_RELAXING);
}

#endif
