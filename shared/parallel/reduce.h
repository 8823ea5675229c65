/* reduce.h - the sum, the smallest and the largest of whole or real numbers, by one fixed tree.
 *
 * Sums of reals round, so their order must not depend on the machine. Item i of REDUCE_ITEMS adds every REDUCE_ITEMS-th
 * number of its tile in order, then a tree joins the items. One group reduces the results of the tiles in the same way:
 *
 *   numbers   | tile 0 | tile 1 | ..        reduce_tiles: one group a tile of REDUCE_TILE
 *   partial     p0       p1       ..        reduce_partials: one group; item i takes p_i, p_(i + REDUCE_ITEMS), ..
 *   result[0]
 *
 * An empty input reduces to the neutral element: 0 for sums, the largest uint for the smallest, 0 for the largest; for
 * reals, plus and minus NEUTRAL_REAL.
 */
#ifndef TANDEM_SHARED_PARALLEL_REDUCE_H
#define TANDEM_SHARED_PARALLEL_REDUCE_H

#include "shared/parallel/length.h"
#include "shared/real.h"

#define REDUCE_TILE 4096u
#define REDUCE_ITEMS 256u

enum { REDUCE_SUM, REDUCE_SMALLEST, REDUCE_LARGEST };

/* The largest float: no finite number lies beyond it. */
#define NEUTRAL_REAL R(3.4028234663852886e38)

SHARED uint neutral_uint(uint operation) { return operation == REDUCE_SMALLEST ? 0xffffffffu : 0u; }
SHARED uint join_uint(uint operation, uint a, uint b)
{
  if (operation == REDUCE_SUM) return a + b;
  return (operation == REDUCE_SMALLEST) == (b < a) ? b : a;
}

SHARED memory_real neutral_real(uint operation)
{
  if (operation == REDUCE_SUM) return R(0.0);
  return operation == REDUCE_SMALLEST ? NEUTRAL_REAL : -NEUTRAL_REAL;
}
SHARED memory_real join_real(uint operation, memory_real a, memory_real b)
{
  if (operation == REDUCE_SUM) return a + b;
  if (operation == REDUCE_SMALLEST) return b < a ? b : a;
  return a < b ? b : a;
}

/* Reduces values[first .. first + count) into result[to]. */
SHARED void reduce_uint(GLOBAL const uint *values, uint first, uint count, uint operation, GLOBAL uint *result, uint to,
                        LOCAL uint *items)
{
  FOR_EACH_ITEM(item, REDUCE_ITEMS)
  {
    uint sum = neutral_uint(operation);
    for (uint i = item; i < count; i += REDUCE_ITEMS) sum = join_uint(operation, sum, values[first + i]);
    items[item] = sum;
  }
  for (uint reach = REDUCE_ITEMS / 2u; reach > 0u; reach /= 2u)
    FOR_EACH_ITEM(item, reach) items[item] = join_uint(operation, items[item], items[item + reach]);
  FOR_EACH_ITEM(only, 1u) result[to] = items[only];
}

SHARED void reduce_real(GLOBAL const memory_real *values, uint first, uint count, uint operation,
                        GLOBAL memory_real *result, uint to, LOCAL memory_real *items)
{
  FOR_EACH_ITEM(item, REDUCE_ITEMS)
  {
    memory_real sum = neutral_real(operation);
    for (uint i = item; i < count; i += REDUCE_ITEMS) sum = join_real(operation, sum, values[first + i]);
    items[item] = sum;
  }
  for (uint reach = REDUCE_ITEMS / 2u; reach > 0u; reach /= 2u)
    FOR_EACH_ITEM(item, reach) items[item] = join_real(operation, items[item], items[item + reach]);
  FOR_EACH_ITEM(only, 1u) result[to] = items[only];
}

SHARED void reduce_tiles_group(GLOBAL const uint *counts, GLOBAL const uint *values, GLOBAL uint *partial, uint length,
                               uint operation, LOCAL uint *local_memory, uint group)
{
  const uint count = items_in_tile(counts[length], REDUCE_TILE, group);
  if (count == 0u) return;
  reduce_uint(values, group * REDUCE_TILE, count, operation, partial, group, local_memory);
}

SHARED void reduce_partials_group(GLOBAL const uint *counts, GLOBAL const uint *partial, GLOBAL uint *result,
                                  uint length, uint operation, LOCAL uint *local_memory, uint group)
{
  if (group != 0u) return;
  reduce_uint(partial, 0u, units_of(counts[length], REDUCE_TILE), operation, result, 0u, local_memory);
}

SHARED void reduce_real_tiles_group(GLOBAL const uint *counts, GLOBAL const memory_real *values,
                                    GLOBAL memory_real *partial, uint length, uint operation, LOCAL uint *local_memory,
                                    uint group)
{
  const uint count = items_in_tile(counts[length], REDUCE_TILE, group);
  if (count == 0u) return;
  reduce_real(values, group * REDUCE_TILE, count, operation, partial, group, (LOCAL memory_real *)local_memory);
}

SHARED void reduce_real_partials_group(GLOBAL const uint *counts, GLOBAL const memory_real *partial,
                                       GLOBAL memory_real *result, uint length, uint operation,
                                       LOCAL uint *local_memory, uint group)
{
  if (group != 0u) return;
  reduce_real(partial, 0u, units_of(counts[length], REDUCE_TILE), operation, result, 0u,
              (LOCAL memory_real *)local_memory);
}

#endif
