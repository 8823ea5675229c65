/* parallel.cl - entries of the primitives in shared/parallel. */
#include "cl/entry.h"
#include "shared/parallel/fill.h"

__kernel void fill(__global uint *values, uint value, RANGE)
{
  FOR_EACH_IN_RANGE(i) fill_item(values, value, i);
}
