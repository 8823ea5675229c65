/* overflow.h - solves the constraints past the last colour in order by one item, for rows that mass_split.h lacks.
 *
 * The result is right and has the same bits everywhere, but the time grows with the number of overflow constraints.
 */
#ifndef TANDEM_SHARED_SOLVE_OVERFLOW_H
#define TANDEM_SHARED_SOLVE_OVERFLOW_H

#include "shared/counts.h"

#define FOR_EACH_OVERFLOW_CONSTRAINT(i) \
  for (uint i = counts[COLOR_START + COLOR_OVERFLOW]; i < counts[COUNT_CONSTRAINTS]; ++i)

#endif
