/* overflow.h - solves the constraints past the last colour in order by one item, for rows that mass_split.h lacks.
 *
 * The result is right and has the same bits everywhere, but the time grows with the number of overflow constraints.
 */
#ifndef TANDEM_SHARED_SOLVE_OVERFLOW_H
#define TANDEM_SHARED_SOLVE_OVERFLOW_H

#include "shared/counts.h"
#include "shared/substep_classes.h"

SHARED uint first_overflow_constraint(GLOBAL const Parameters *parameters, GLOBAL const uint *counts)
{
  uint colors = parameters->substep_class == MANY_SUBSTEPS ? (uint)MANY_COLOR_START : (uint)COLOR_START;
  return counts[colors + COLOR_OVERFLOW];
}

SHARED uint end_of_overflow_constraints(GLOBAL const Parameters *parameters, GLOBAL const uint *counts)
{
  return counts[parameters->substep_class == FEW_SUBSTEPS ? MANY_COLOR_START + COLOR_OVERFLOW
                                                          : (uint)COUNT_CONSTRAINTS];
}

#define FOR_EACH_OVERFLOW_CONSTRAINT(i) \
  for (uint i = first_overflow_constraint(parameters, counts); i < end_of_overflow_constraints(parameters, counts); ++i)

#endif
