/* table_limits.h - how many entries of the table of sleepers may be out of order; for the host, too. Each body that is
 * awake is tested against all of them. */
#ifndef TANDEM_SHARED_SLEEPING_TABLE_LIMITS_H
#define TANDEM_SHARED_SLEEPING_TABLE_LIMITS_H

#include "shared/platform.h"

#define MOST_UNSORTED_SLEEPERS 256u

#endif
