/* cache_rolling.h - hands the torques of rolling friction to the next step, as commit.h does with other impulses. */
#ifndef TANDEM_SHARED_INTEGRATE_CACHE_ROLLING_H
#define TANDEM_SHARED_INTEGRATE_CACHE_ROLLING_H

#include "shared/records.h"

SHARED void cache_rolling_item(GLOBAL const uint *constraint_pair, GLOBAL const row *constraint_rolling,
                               GLOBAL row *cached_rolling_impulse, item_index i)
{
  store_row(cached_rolling_impulse, load_natural(constraint_pair, i), load_row(constraint_rolling, i));
}

#endif
