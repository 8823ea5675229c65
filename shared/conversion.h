/* conversion.h - conversions to integers that saturate. An out-of-range cast is undefined in C and differs between
 * devices, so these functions clamp before they cast. Only ITEM and GROUP kernels (width 1) use them. */
#ifndef TANDEM_SHARED_CONVERSION_H
#define TANDEM_SHARED_CONVERSION_H

#include "shared/math.h"

#define INT_LIMIT R(1073741824.0)

/* Toward minus infinity, saturating at +-2^30; NaN gives 0. */
SHARED int floor_to_int(real x)
{
  real number = x == x ? x : R(0.0);
  real limited = clamped(number, -INT_LIMIT, INT_LIMIT);
  int truncated = truncate_to_int(limited);
  return truncated - (int)((real)truncated > limited);
}

/* The bits of a float as an unsigned integer with the same order; -0 comes just below +0. */
SHARED uint ordered_bits(uint bits) { return bits ^ ((bits >> 31) != 0u ? 0xffffffffu : 0x80000000u); }

#endif
