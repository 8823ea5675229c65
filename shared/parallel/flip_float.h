/* flip_float.h - maps floats to unsigned integers of the same order and back, so that the radix sort can sort floats.
 *
 *   float      -inf .. -1 .. -denormal  -0   +0  +denormal .. 1 .. +inf
 *   bits        all inverted                 sign bit set
 *   key         0x007fffff    ..  0x7fffffff 0x80000000  ..   0xff800000
 *
 * -0 comes right before +0. NaNs lie beyond the infinities of their sign. The mapping is that of Herf, "Radix Tricks",
 * 2001.
 */
#ifndef TANDEM_SHARED_PARALLEL_FLIP_FLOAT_H
#define TANDEM_SHARED_PARALLEL_FLIP_FLOAT_H

#include "shared/platform.h"

SHARED uint flip_float_bits(uint bits) { return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u; }
SHARED uint unflip_float_bits(uint key) { return (key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key; }

SHARED void flip_float_item(GLOBAL uint *values, uint i) { values[i] = flip_float_bits(values[i]); }
SHARED void unflip_float_item(GLOBAL uint *values, uint i) { values[i] = unflip_float_bits(values[i]); }

#endif
