/* item_kernels.h - ITEM and GROUP kernels of the module `probe`. */
#ifndef TESTS_MODULE_ITEM_KERNELS_H
#define TESTS_MODULE_ITEM_KERNELS_H

#include "shared/argument_groups.h"
#include "shared/records.h"

SHARED void probe_turn_back_item(GLOBAL float4 *body_velocity, uint i)
{
  spatial_velocity m = load_velocity(body_velocity, i);
  m.linear = scale(m.linear, R(-1.0));
  store_velocity(body_velocity, i, m);
}

/* Each body moves as the hit of its ray says: along the normal, at the speed of the fraction. */
SHARED void probe_see_item(GLOBAL const float4 *query_hit, GLOBAL const uint *query_hit_body,
                           GLOBAL float4 *body_velocity, uint i)
{
  spatial_velocity m = load_velocity(body_velocity, i);
  vec4 hit = load_float4(query_hit, i);
  if (query_hit_body[i] == INDEX_NONE) return;
  m.linear = scale(xyz(hit), hit.w);
  store_velocity(body_velocity, i, m);
}

/* A pair has no contact where a ray of one of its bodies hits nothing. */
SHARED void probe_see_pairs_item(read_pairs pairs, GLOBAL const uint *query_hit_body, GLOBAL uint *manifold_count,
                                 uint i)
{
  if (query_hit_body[pairs.a[i]] == INDEX_NONE || query_hit_body[pairs.b[i]] == INDEX_NONE) manifold_count[i] = 0u;
}

/* How many steps each body has seen. */
SHARED void probe_count_item(GLOBAL const uint *previous_probe_age, GLOBAL uint *probe_age, uint i)
{
  probe_age[i] = previous_probe_age[i] + 1u;
}

/* In how many steps there were so many pairs. */
SHARED void probe_count_places_item(GLOBAL const uint *previous_probe_place_age, GLOBAL uint *probe_place_age, uint i)
{
  probe_place_age[i] = previous_probe_place_age[i] + 1u;
}

/* A pair with a ghost has no contact. */
SHARED void probe_drop_item(read_pairs pairs, GLOBAL const uint *probe_ghost, GLOBAL uint *manifold_count, uint i)
{
  if (probe_ghost[pairs.a[i]] || probe_ghost[pairs.b[i]]) manifold_count[i] = 0u;
}

#define PROBE_ITEMS 256u

/* The sum of a tile. */
SHARED void probe_sum_group(GLOBAL const uint *counts, GLOBAL const uint *values, GLOBAL uint *probe_total,
                            LOCAL uint *local_memory, uint group)
{
  uint bodies = counts[COUNT_BODIES];
  FOR_EACH_ITEM(item, PROBE_ITEMS)
  {
    uint sum = 0u;
    for (uint i = group * TILE + item; i < (group + 1u) * TILE; i += PROBE_ITEMS) sum += i < bodies ? values[i] : 0u;
    local_memory[item] = sum;
  }
  for (uint reach = PROBE_ITEMS / 2u; reach > 0u; reach /= 2u)
    FOR_EACH_ITEM(item, reach) local_memory[item] += local_memory[item + reach];
  FOR_EACH_ITEM(only, 1u) probe_total[group] = local_memory[only];
}

#endif
