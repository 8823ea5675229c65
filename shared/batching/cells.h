/* cells.h - the two-stage batching of the talks (GS-4150 slide 44, 2015 talk): cells of space first, then the contacts
 * within each cell.
 *
 * A contact belongs to the cell of its first body that can move. Cells have eight classes, by the parity of their three
 * numbers; cells of one class are never neighbours, so they can be worked on at once, a work-group each:
 *
 *      +---+---+---+---+        class 0, then 1, 2, 3 (here in the plane: four classes)
 *      | 2 | 3 | 2 | 3 |
 *      +---+---+---+---+        The talk asks for cells larger than the largest body. That is not enough: a body that
 *      | 0 | 1 | 0 | 1 |        reaches over cell 1 touches contacts of both cells 0, and both groups write it.
 *      +---+---+---+---+
 *
 * Here each body notes, for each class, the lowest cell of that class that has a contact with it. A contact is worked
 * on in its cell only if its cell is the one noted at both of its moving bodies; then no body is touched by two cells
 * of one class, whatever the sizes. The contacts left over, none where cells are wider than two bodies, are coloured by
 * the rounds of coloring.h after the cells.
 *
 * The number of a cell is a hash, because space is unbounded. Cells that share a number are worked on by one group, as
 * one cell.
 */
#ifndef TANDEM_SHARED_BATCHING_CELLS_H
#define TANDEM_SHARED_BATCHING_CELLS_H

#include "shared/batching/coloring.h"
#include "shared/batching/limits.h"
#include "shared/batching/order.h"
#include "shared/conversion.h"

/* The result is never negative, because floor_to_int saturates at 2^30. */
SHARED uint place_along(real position, real inverse_cell)
{
  return (uint)(floor_to_int(position * inverse_cell) + 1073741824);
}

/* The key is class * cells + cell, where cells is a power of two. */
SHARED uint cell_key(vec3 position, real inverse_cell, uint cells)
{
  uint x = place_along(position.x, inverse_cell), y = place_along(position.y, inverse_cell),
       z = place_along(position.z, inverse_cell);
  uint parity = (x & 1u) | (y & 1u) << 1 | (z & 1u) << 2;
  uint hash = (x >> 1) * 0x9e3779b1u + (y >> 1) * 0x85ebca77u + (z >> 1) * 0xc2b2ae3du;
  return parity * cells + ((hash ^ hash >> 15) & (cells - 1u));
}

SHARED uint cell_of_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                         GLOBAL const float4 *body_position, GLOBAL const uint *counts, uint a, uint b)
{
  uint body = is_moving(body_flags, a) ? a : b;
  return cell_key(load_position(body_position, body).high, (real)parameters->inverse_batch_cell,
                  counts[COUNT_BATCH_CELLS]);
}

SHARED void clear_cells_item(GLOBAL uint *body_cells, uint i)
{
  for (uint k = 0; k < CELL_CLASSES; ++k) body_cells[CELL_CLASSES * i + k] = INDEX_NONE;
}

SHARED void claim_cells_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                             GLOBAL const uint *body_flags, GLOBAL const float4 *body_position,
                             GLOBAL const uint *pair_color, GLOBAL const uint *counts, GLOBAL uint *body_cells, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  uint a = pair_a[i], b = pair_b[i], key = cell_of_pair(parameters, body_flags, body_position, counts, a, b);
  uint parity = key / counts[COUNT_BATCH_CELLS];
  if (is_moving(body_flags, a)) ATOMIC_MIN(body_cells + CELL_CLASSES * a + parity, key);
  if (is_moving(body_flags, b)) ATOMIC_MIN(body_cells + CELL_CLASSES * b + parity, key);
}

SHARED uint owns_body(GLOBAL const uint *body_flags, GLOBAL const uint *body_cells, uint body, uint parity, uint key)
{
  return !is_moving(body_flags, body) || body_cells[CELL_CLASSES * body + parity] == key ? 1u : 0u;
}

/* The key of a contact is its cell if no other cell can touch it; all other contacts sort behind the last cell. */
SHARED void cell_keys_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                           GLOBAL const uint *body_flags, GLOBAL const float4 *body_position,
                           GLOBAL const uint *pair_color, GLOBAL const uint *counts, GLOBAL const uint *body_cells,
                           GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint cells = counts[COUNT_BATCH_CELLS], behind = CELL_CLASSES * cells;
  uint a = pair_a[i], b = pair_b[i];
  uint key = pair_color[i] == COLOR_NONE ? cell_of_pair(parameters, body_flags, body_position, counts, a, b) : behind;
  uint inside = key < behind && owns_body(body_flags, body_cells, a, key / cells, key) &&
                owns_body(body_flags, body_cells, b, key / cells, key);
  sort_key[i] = inside ? key : behind;
  sort_value[i] = i;
}

SHARED void clear_bids(GLOBAL const uint *body_flags, GLOBAL uint *body_bid, uint body)
{
  if (!is_moving(body_flags, body)) return;
  ATOMIC_MIN(body_bid + 2u * body, 0u);
  ATOMIC_MIN(body_bid + 2u * body + 1u, 0u);
}

/* One group for each cell of the class `parity` runs the rounds of coloring.h over the cell's contacts.
 * local_memory[round]: contacts without a colour before the round. The group clears its bids, so that the next kernel
 * finds none. */
SHARED void color_cells_group(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                              GLOBAL const uint *sort_key, GLOBAL const uint *sort_value, GLOBAL uint *counts,
                              GLOBAL uint *pair_color, GLOBAL uint *body_colors, GLOBAL uint *body_bid, uint parity,
                              LOCAL uint *local_memory, uint group)
{
  const uint pairs = counts[COUNT_PAIRS], key = parity * counts[COUNT_BATCH_CELLS] + group;
  const uint first = first_not_below(sort_key, pairs, key), count = first_not_below(sort_key, pairs, key + 1u) - first;
  if (group >= counts[COUNT_BATCH_CELLS] || count == 0u) return;
  FOR_EACH_ITEM(round, CELL_ROUNDS + 1u) local_memory[round] = round == 0u ? count : 0u;
  for (uint round = 0u; round < CELL_ROUNDS; ++round) {
    FOR_EACH_ITEM(k, count)
    {
      const uint pair = sort_value[first + k];
      if (pair_color[pair] == COLOR_NONE)
        place_bid(body_flags, body_bid, pair_a[pair], pair_b[pair], bid_of(pair), round);
    }
    const uint active = local_memory[round] > 0u ? count : 0u;
    FOR_EACH_ITEM(k, active)
    {
      const uint pair = sort_value[first + k];
      if (pair_color[pair] == COLOR_NONE)
        assign_color(body_flags, counts, pair_color, body_colors, body_bid, pair_a[pair], pair_b[pair], bid_of(pair),
                     round, pair);
      if (pair_color[pair] == COLOR_NONE) LOCAL_ADD(local_memory + round + 1u, 1u);
    }
  }
  FOR_EACH_ITEM(k, count)
  {
    clear_bids(body_flags, body_bid, pair_a[sort_value[first + k]]);
    clear_bids(body_flags, body_bid, pair_b[sort_value[first + k]]);
  }
}

#endif
