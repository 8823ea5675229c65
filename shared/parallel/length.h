/* length.h - the length of a primitive's input, which only the device knows.
 *
 * A primitive works on words = per_unit * ceil(counts[length] / unit) words. This is the length itself (1, 1), or a
 * table with some entries for each tile of another array, such as the histograms of the radix sort. The host launches
 * for the capacity, and groups past the end return at once.
 */
#ifndef TANDEM_SHARED_PARALLEL_LENGTH_H
#define TANDEM_SHARED_PARALLEL_LENGTH_H

#include "shared/platform.h"

/* Counts saturate at the largest uint instead of wrapping to 0, so that an overflow stays visible. A sum of counts is
 * exact or saturated, however it is divided and ordered. */
SHARED uint saturated_sum(uint a, uint b)
{
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}

/* ceil(n / unit), for every n. */
SHARED uint units_of(uint n, uint unit) { return n / unit + (n % unit != 0u ? 1u : 0u); }

/* The number of items of tile `index`, of `tile` items each, that lie below n; 0 past the end. */
SHARED uint items_in_tile(uint n, uint tile, uint index)
{
  uint first = index * tile;
  if (index >= units_of(n, tile)) return 0u;
  return n - first < tile ? n - first : tile;
}

#endif
