/* curve.h - the order along a space-filling curve: Morton codes of the centres of bounds (Lauterbach and others, "Fast
 * BVH construction on GPUs", 2009). Bodies that are near on the curve are near in space, so trees and sorted lists are
 * built over it. */
#ifndef TANDEM_SHARED_BROADPHASE_CURVE_H
#define TANDEM_SHARED_BROADPHASE_CURVE_H

#include "shared/broadphase/extent.h"

/* Spreads ten bits to every third bit. */
SHARED uint spread_bits(uint x)
{
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}
SHARED uint curve_cell(real offset, real scale)
{
  int cell = floor_to_int(offset * scale);
  return cell < 0 ? 0u : cell < CURVE_CELLS ? (uint)cell : (uint)CURVE_CELLS - 1u;
}

/* The frame is that of the small bodies; large bodies outside of it are clamped to its border. */
SHARED uint curve_key(GLOBAL const float4 *grid, box_bounds box)
{
  vec4 frame = load_float4(grid, 1u);
  vec3 offset = subtract(scale(add(box.lower, box.upper), R(0.5)), xyz(frame));
  return spread_bits(curve_cell(offset.x, frame.w)) << 2 | spread_bits(curve_cell(offset.y, frame.w)) << 1 |
         spread_bits(curve_cell(offset.z, frame.w));
}

/* The sort key of body i, which has finite bounds. */
SHARED void curve_keys_item(GLOBAL const float4 *bounds, GLOBAL const float4 *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_UNBOUNDED] + i;
  sort_key[i] = curve_key(grid, load_bounds(bounds, body));
  sort_value[i] = body;
}

#endif
