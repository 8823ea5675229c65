/* tail.h - the constraints past the last colour, in order by one item: for rows that mass_split.h does not have.
 *
 * Right and the same everywhere, but as slow as the tail is long.
 */
#ifndef TANDEM_SHARED_SOLVE_TAIL_H
#define TANDEM_SHARED_SOLVE_TAIL_H

#include "shared/counts.h"

#define FOR_EACH_IN_TAIL(i) for (uint i = counts[COLOR_START + COLOR_TAIL]; i < counts[COUNT_CONSTRAINTS]; ++i)

#endif
