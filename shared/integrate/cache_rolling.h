/* cache_rolling.h - caches the torques of rolling friction for the next step, as commit.h does with other impulses. */
#ifndef TANDEM_SHARED_INTEGRATE_CACHE_ROLLING_H
#define TANDEM_SHARED_INTEGRATE_CACHE_ROLLING_H

#include "shared/records.h"

SHARED void cache_rolling_item(GLOBAL const uint *constraint_pair, GLOBAL const float4 *constraint_rolling,
                               GLOBAL float4 *cached_rolling_impulse, item_index i)
{
  store_float4(cached_rolling_impulse, load_uint(constraint_pair, i), load_float4(constraint_rolling, i));
}

#endif
