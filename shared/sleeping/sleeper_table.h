/* sleeper_table.h - the table of the sleeping bodies, in which those awake look for what they come near to.
 *
 * The boxes of sleeping bodies do not move, so they are sorted once, by the cell of their centre. A cell is as wide as
 * the largest of them. Boxes that are large beside the others have a key behind all cells.
 *
 *     | sorted by cells            | large | fell asleep since |
 *       3   9   none   4   ...                  17   18              sleeper_body
 *
 * A world whose islands fall asleep and wake must not sort all sleepers each time, so the table is changed where they
 * are few: who falls asleep is appended, and who wakes leaves its place empty. Bodies that change their index when
 * others wake are renumbered; sleeper_place says where they stand. The host has all of it sorted anew when much has
 * been appended, and when bodies were created or destroyed (host/world/sleep.cpp).
 *
 * The table only decides which pairs are tested, and not with what result.
 */
#ifndef TANDEM_SHARED_SLEEPING_SLEEPER_TABLE_H
#define TANDEM_SHARED_SLEEPING_SLEEPER_TABLE_H

#include "shared/argument_groups.h"
#include "shared/broadphase/overlap.h"
#include "shared/conversion.h"
#include "shared/records.h"

/* Coordinates of cells are taken modulo 2^CELL_BITS; cells that share a key cost time and change no result. */
#define CELL_BITS 10u
#define LARGE_SLEEPER (1u << (3u * CELL_BITS))
SHARED real larger_half_extent(box_bounds box)
{
  vec3 size = subtract(box.upper, box.lower);
  return R(0.5) * maximum(size.x, maximum(size.y, size.z));
}

/* The boxes larger than this have no cell. */
SHARED mask is_large_sleeper(GLOBAL const Parameters *parameters, box_bounds box)
{
  return larger_half_extent(box) > R(2.0) * parameters->hybrid_cell;
}

/* Positive floats have the order of their bits. The factor exceeds what rounding to a float may take away. */
SHARED void measure_sleepers_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *bounds, GLOBAL uint *counts,
                                  uint i)
{
  box_bounds box = load_bounds(bounds, i);
  if (!is_large_sleeper(parameters, box))
    ATOMIC_MAX(counts + COUNT_SLEEPER_REACH, FLOAT_BITS(R(1.000001) * larger_half_extent(box)));
}

SHARED real reach_of_sleepers(GLOBAL const uint *counts) { return BITS_FLOAT(counts[COUNT_SLEEPER_REACH]); }

/* The reach is 0 if all sleepers are large: the quotient is then infinite or no number, and floor_to_int takes it. */
SHARED int sleeper_cell_along(real x, real reach) { return floor_to_int(x / (R(2.0) * reach)); }

SHARED uint key_of_cell(int x, int y, int z)
{
  uint most = (1u << CELL_BITS) - 1u;
  return ((uint)x & most) | ((uint)y & most) << CELL_BITS | ((uint)z & most) << (2u * CELL_BITS);
}

SHARED void sleeper_keys_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *bounds,
                              GLOBAL const uint *counts, GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint place = i - counts[COUNT_BODIES];
  box_bounds box = load_bounds(bounds, i);
  vec3 center = scale(add(box.lower, box.upper), R(0.5));
  real reach = reach_of_sleepers(counts);
  sort_key[place] = is_large_sleeper(parameters, box)
                        ? LARGE_SLEEPER
                        : key_of_cell(sleeper_cell_along(center.x, reach), sleeper_cell_along(center.y, reach),
                                      sleeper_cell_along(center.z, reach));
  sort_value[place] = i;
}

SHARED void store_sleeper(GLOBAL const float4 *bounds, write_sleepers sleepers, GLOBAL uint *sleeper_place, uint place,
                          uint body)
{
  sleepers.body[place] = body;
  sleeper_place[body] = place;
  store_float4(sleepers.bounds, 2u * place, load_float4(bounds, 2u * body));
  store_float4(sleepers.bounds, 2u * place + 1u, load_float4(bounds, 2u * body + 1u));
}

SHARED void keep_sleepers_item(GLOBAL const uint *sort_key, GLOBAL const uint *sort_value, GLOBAL const float4 *bounds,
                               write_sleepers sleepers, GLOBAL uint *sleeper_place, GLOBAL uint *counts, uint i)
{
  sleepers.key[i] = sort_key[i];
  store_sleeper(bounds, sleepers, sleeper_place, i, sort_value[i]);
  if (i == 0u) counts[COUNT_SORTED_SLEEPERS] = counts[COUNT_LISTED_SLEEPERS] = counts[COUNT_SLEEPERS];
}

/* A body that has just fallen asleep; those that did lie before all other sleepers. */
SHARED void append_sleepers_item(GLOBAL const float4 *bounds, GLOBAL const uint *counts, write_sleepers sleepers,
                                 GLOBAL uint *sleeper_place, uint i)
{
  store_sleeper(bounds, sleepers, sleeper_place, counts[COUNT_LISTED_SLEEPERS] + i - counts[COUNT_BODIES], i);
}

/* One of the bodies that were moved when others woke, and have taken their rows of sleeper_place along. */
SHARED void renumber_sleepers_item(GLOBAL const uint *move_to, GLOBAL const uint *sleeper_place,
                                   GLOBAL uint *sleeper_body, uint awake, uint i)
{
  uint body = move_to[i];
  sleeper_body[sleeper_place[body]] = body < awake ? INDEX_NONE : body;
}

#endif
