/* length.h - how long a primitive's input is, known on the device alone.
 *
 * A primitive works on words = per_unit * ceil(counts[length] / unit) words: the length itself (1, 1), or a
 * table with some entries per tile of another array, as the histograms of the radix sort. Only the
 * device knows it; the host launches for the capacity, and groups past the end return at once.
 */
#ifndef TANDEM_SHARED_PARALLEL_LENGTH_H
#define TANDEM_SHARED_PARALLEL_LENGTH_H

#include "shared/platform.h"

/* Counts stop at the largest uint instead of starting again at 0, so that what is too much stays too much. However a
 * sum of counts is parted and ordered, it is the true one, or that largest. */
SHARED uint saturated_sum(uint a, uint b)
{
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}

/* ceil(n / unit), for every n. */
SHARED uint units_of(uint n, uint unit) { return n / unit + (n % unit != 0u ? 1u : 0u); }

/* How many of the `tile` items of tile `index` lie below n; 0 past the end. */
SHARED uint items_in_tile(uint n, uint tile, uint index)
{
  uint first = index * tile;
  if (index >= units_of(n, tile)) return 0u;
  return n - first < tile ? n - first : tile;
}

#endif
