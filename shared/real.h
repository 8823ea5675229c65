/* real.h - numbers, masks and memory access at the width of one item.
 *
 * This file holds width 1, which OpenCL, gdb and loop tails use. minicl/lanes.h gives the same names for 4, 8 or 16
 * lanes. A LANES kernel uses nothing beyond these names.
 *
 *   choose(m, a, b)          m ? a : b, both sides evaluated
 *   item_index               the index of an item (lanes: the first of a run of items, so that memory is read in
 *                            order); the sum with a uint is an item_index, any other arithmetic makes a uint_lanes
 *   any_index                either of both, as a parameter: an item, or one that each lane chooses
 *   FOR_EACH_LISTED(k, n)    in a group: the items of a list of n, k the first of those at a time
 *   listed_item, is_listed   these items, and whether there are so many
 *   any_of(m)                some item of the group has it (uniform, so `if` may use it)
 *   load*, store*, *_if      memory by item index; _if writes only where the mask holds; listed: by an index from a
 *                            list, whose lanes are mostly neighbours in memory
 */
#ifndef TANDEM_SHARED_REAL_H
#define TANDEM_SHARED_REAL_H

#include "shared/platform.h"

/* A literal in the precision of the build: R(0.1) is 0.1f, or 0.1 in the reference build. */
#ifdef TANDEM_REFERENCE
#define R(literal) literal
#else
#define R(literal) literal##f
#endif

/* The largest relative error of one rounding. */
#ifdef TANDEM_REFERENCE
#define ROUNDING 1.2e-16
#else
#define ROUNDING 6.0e-8f
#endif

#ifndef TANDEM_LANES

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
typedef float memory_real;
#endif
typedef memory_real real;
typedef uint uint_lanes;
typedef uint item_index;
typedef uint any_index;
typedef int mask;

typedef struct {
  real x, y, z, w;
} vec4;

#define choose(m, a, b) ((m) ? (a) : (b))

SHARED int any_of(mask m) { return m; }

#define FOR_EACH_LISTED(k, n) FOR_EACH_ITEM(k, n)
SHARED uint_lanes listed_item(LOCAL const uint *list, uint n, uint k)
{
  (void)n;
  return list[k];
}
SHARED mask is_listed(uint n, uint k) { return k < n; }

SHARED real square_root(real x) { return SQUARE_ROOT(x); }
/* Truncation toward zero; the caller keeps |x| below 2^31. */
SHARED int truncate_to_int(real x) { return (int)x; }
SHARED uint_lanes to_uint(real x) { return (uint_lanes)(int)x; }
SHARED real to_real(uint_lanes x) { return (real)x; }
SHARED real int_to_real(uint_lanes two_complement) { return (real)(int)two_complement; }

SHARED uint_lanes real_bits(real x) { return FLOAT_BITS(x); }
SHARED real real_of_bits(uint_lanes bits) { return BITS_FLOAT(bits); }

SHARED real load_real(GLOBAL const memory_real *from, uint_lanes i) { return from[i]; }
SHARED uint_lanes load_uint(GLOBAL const uint *from, uint_lanes i) { return from[i]; }
SHARED void store_real(GLOBAL memory_real *to, uint_lanes i, real value) { to[i] = value; }
SHARED void store_uint(GLOBAL uint *to, uint_lanes i, uint_lanes value) { to[i] = value; }
SHARED void store_uint_if(mask m, GLOBAL uint *to, uint_lanes i, uint_lanes value)
{
  if (m) to[i] = value;
}
SHARED void atomic_min_if(mask m, GLOBAL uint *to, uint at, uint_lanes value)
{
  if (m) ATOMIC_MIN(to + at, value);
}
SHARED void atomic_max_if(mask m, GLOBAL uint *to, uint_lanes at, uint_lanes value)
{
  if (m) ATOMIC_MAX(to + at, value);
}
/* Of two numbers beside each other. */
SHARED void atomic_max_both_if(mask m, GLOBAL uint *to, uint_lanes at, uint_lanes first, uint_lanes second)
{
  if (!m) return;
  ATOMIC_MAX(to + at, first);
  ATOMIC_MAX(to + at + 1u, second);
}
SHARED void atomic_add_if(mask m, GLOBAL uint *to, uint_lanes at, uint value)
{
  if (m) ATOMIC_ADD(to + at, value);
}
SHARED void atomic_clear_if(mask m, GLOBAL uint *to, uint_lanes at)
{
  if (m) ATOMIC_MIN(to + at, 0u);
}

SHARED vec4 load_float4(GLOBAL const float4 *from, uint_lanes i)
{
  float4 r = from[i];
  vec4 v = {r.x, r.y, r.z, r.w};
  return v;
}
SHARED void store_float4(GLOBAL float4 *to, uint_lanes i, vec4 v)
{
  float4 r;
  r.x = v.x;
  r.y = v.y;
  r.z = v.z;
  r.w = v.w;
  to[i] = r;
}
SHARED void store_float4_if(mask m, GLOBAL float4 *to, uint_lanes i, vec4 v)
{
  if (m) store_float4(to, i, v);
}
SHARED void store_listed_row_if(mask m, GLOBAL float4 *to, uint_lanes i, vec4 v) { store_float4_if(m, to, i, v); }
SHARED void store_listed_uint_if(mask m, GLOBAL uint *to, uint_lanes i, uint_lanes value)
{
  store_uint_if(m, to, i, value);
}
SHARED void store_listed_real_if(mask m, GLOBAL memory_real *to, uint_lanes i, real value)
{
  if (m) to[i] = value;
}

#endif /* TANDEM_LANES */

#endif
