/* lanes_kernels.h - the kernels of the module `probe` that run in lanes. */
#ifndef TESTS_MODULE_LANES_KERNELS_H
#define TESTS_MODULE_LANES_KERNELS_H

#include "shared/counts.h"
#include "shared/records.h"

SHARED void probe_push_item(GLOBAL const float4 *probe_force, GLOBAL float4 *solver_velocity, uint times, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  float4 force = probe_force[0];
  m.linear = add(m.linear, scale(make_vec3(force.x, force.y, force.z), (real)(memory_real)times));
  store_velocity_if(m.inverse_mass > R(0.0), solver_velocity, i, m);
}

/* Halves the velocity of the bodies of a tile that move up or down faster than 1 m/s. */
SHARED void probe_calm_group(GLOBAL const uint *counts, GLOBAL float4 *body_velocity, LOCAL uint *local_memory,
                             uint group)
{
  const uint first = group * TILE, left = counts[COUNT_BODIES] - first, bodies = left < TILE ? left : TILE;
  FOR_EACH_ITEM(only, 1u) local_memory[only] = 0u;
  FOR_EACH_ITEM(k, bodies)
  {
    const float speed = body_velocity[2u * (first + k)].y;
    if (speed > 1.0f || speed < -1.0f) local_memory[1u + LOCAL_ADD(local_memory, 1u)] = first + k;
  }
  FOR_EACH_LISTED(k, local_memory[0])
  {
    uint_lanes i = listed_item(local_memory + 1u, local_memory[0], k);
    spatial_velocity m = load_velocity(body_velocity, i);
    m.linear = scale(m.linear, R(0.5));
    store_velocity_if(is_listed(local_memory[0], k), body_velocity, i, m);
  }
}

#endif
