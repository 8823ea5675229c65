/* strip.h - eight numbers of one item, worked on at once: tables of a shape that an item scans from end to end.
 *
 * LANES kernels put eight items side by side; a kernel whose items branch apart (ITEM) cannot, but may scan its own
 * tables eight entries a step: vertices for the highest, faces for the nearest. Stored number by number:
 *
 *   row     0        1        2        3        4        5
 *        x0..x3   x4..x7   y0..y3   y4..y7   z0..z3   z4..z7        then the next eight vertices
 *
 * The last strip is filled up with its table's first entry, which ties with itself and, having the lower index, wins.
 * Arithmetic is per number, in the order written, so the bits are those of a plain loop. Strips are never passed by
 * value: wide vectors on the stack are aligned differently from compiler to compiler.
 */
#ifndef TANDEM_SHARED_STRIP_H
#define TANDEM_SHARED_STRIP_H

#include "shared/real.h"

#define STRIP 8u
#define ROWS_OF_STRIP 2u

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
typedef float8 strip;
typedef uint8 strip_index;
#define STRIP_CHOOSE(m, a, b) ((m) ? (a) : (b))
#define STRIP_CHOOSE_INDEX(m, a, b) ((m) ? (a) : (b))
#define STRIP_IOTA ((uint8)(0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u))
#define STRIP_ALL(x) ((float8)(x))
#define STRIP_OF(a, b, c, d, e, f, g, h) ((float8)((a), (b), (c), (d), (e), (f), (g), (h)))
#define STRIP_STORE(to, from) vstore8(*(from), 0, (to))
#define STRIP_LOAD(to, from, at) (*(to) = (float8)((from)[at], (from)[(at) + 1u]))
#else
#ifdef TANDEM_REFERENCE
typedef double strip __attribute__((vector_size(64)));
typedef int64_t strip_mask __attribute__((vector_size(64)));
typedef uint64_t strip_index __attribute__((vector_size(64)));
#else
typedef float strip __attribute__((vector_size(32)));
typedef int32_t strip_mask __attribute__((vector_size(32)));
typedef uint32_t strip_index __attribute__((vector_size(32)));
#endif
#ifdef __cplusplus
#define STRIP_CHOOSE(m, a, b) ((m) ? (a) : (b))
#define STRIP_CHOOSE_INDEX(m, a, b) ((m) ? (a) : (b))
#else /* C has no choice between vectors before GCC 14 */
#define STRIP_CHOOSE(m, a, b) ((strip)(((m) & (strip_mask)(a)) | (~(m) & (strip_mask)(b))))
#define STRIP_CHOOSE_INDEX(m, a, b) ((strip_index)(((m) & (strip_mask)(a)) | (~(m) & (strip_mask)(b))))
#endif
#define STRIP_IOTA \
  (strip_index) { 0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u }
#define STRIP_OF(a, b, c, d, e, f, g, h) ((strip){(a), (b), (c), (d), (e), (f), (g), (h)})
#define STRIP_ALL(x) STRIP_OF(x, x, x, x, x, x, x, x)
#define STRIP_STORE(to, from) __builtin_memcpy((to), (from), sizeof(strip))
#define STRIP_LOAD(to, from, at) __builtin_memcpy((to), (from) + (at), sizeof(strip))
#endif

/* The highest number of each of the eight columns, and where it stands. */
typedef struct {
  strip height;
  strip_index at;
} strip_leader;

SHARED void load_strip(strip *to, GLOBAL const row *from, natural at) { STRIP_LOAD(to, from, at); }
SHARED void store_strip(real *to, const strip *from) { STRIP_STORE(to, from); }

/* Below all that is finite: a column of NaN then names the first entry. */
SHARED void start_strip_leader(strip_leader *best)
{
  strip_index zero = STRIP_IOTA - STRIP_IOTA;
  strip lowest = STRIP_ALL(R(-1e30));
  best->at = zero;
  best->height = lowest;
}
/* first: index of the strip's first number. */
SHARED void challenge_by_strip(strip_leader *best, const strip *height, uint first)
{
  strip_index at = STRIP_IOTA + first;
  best->at = STRIP_CHOOSE_INDEX(*height > best->height, at, best->at);
  best->height = STRIP_CHOOSE(*height > best->height, *height, best->height);
}

/* The highest of all; of equal ones the lowest index. */
typedef struct {
  real height;
  uint at;
} highest_entry;

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
SHARED highest_entry highest_of_strip(const strip_leader *best)
{
  float4 low = best->height.lo, high = best->height.hi;
  uint4 at_low = best->at.lo, at_high = best->at.hi;
  int4 wins = (high > low) | ((high == low) & (at_high < at_low));
  float4 h = wins ? high : low;
  uint4 at = wins ? at_high : at_low;
  highest_entry top = {h.x, at.x};
  if (h.y > top.height || (h.y == top.height && at.y < top.at)) {
    top.height = h.y;
    top.at = at.y;
  }
  if (h.z > top.height || (h.z == top.height && at.z < top.at)) {
    top.height = h.z;
    top.at = at.z;
  }
  if (h.w > top.height || (h.w == top.height && at.w < top.at)) {
    top.height = h.w;
    top.at = at.w;
  }
  return top;
}
#else
SHARED highest_entry highest_of_strip(const strip_leader *best)
{
  strip h = best->height;
  strip_index at = best->at, none = ~(at ^ at);
  strip turned = __builtin_shufflevector(h, h, 4, 5, 6, 7, 0, 1, 2, 3);
  h = STRIP_CHOOSE(turned > h, turned, h);
  turned = __builtin_shufflevector(h, h, 2, 3, 0, 1, 6, 7, 4, 5);
  h = STRIP_CHOOSE(turned > h, turned, h);
  turned = __builtin_shufflevector(h, h, 1, 0, 3, 2, 5, 4, 7, 6);
  h = STRIP_CHOOSE(turned > h, turned, h);
  at = STRIP_CHOOSE_INDEX(best->height == h, at, none);
  strip_index other = __builtin_shufflevector(at, at, 4, 5, 6, 7, 0, 1, 2, 3);
  at = STRIP_CHOOSE_INDEX(other < at, other, at);
  other = __builtin_shufflevector(at, at, 2, 3, 0, 1, 6, 7, 4, 5);
  at = STRIP_CHOOSE_INDEX(other < at, other, at);
  other = __builtin_shufflevector(at, at, 1, 0, 3, 2, 5, 4, 7, 6);
  at = STRIP_CHOOSE_INDEX(other < at, other, at);
  highest_entry top = {h[0], (uint)at[0]};
  return top;
}
#endif

#endif
