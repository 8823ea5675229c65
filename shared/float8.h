/* float8.h - eight floats of one item, for tables of a shape that an item scans from end to end.
 *
 * LANES kernels process several items side by side. A kernel whose items diverge (ITEM) cannot do so, but it can scan
 * its own tables eight entries at a time: vertices for the highest, faces for the nearest. A table is stored coordinate
 * by coordinate:
 *
 *   row     0        1        2        3        4        5
 *        x0..x3   x4..x7   y0..y3   y4..y7   z0..z3   z4..z7        then the next eight vertices
 *
 * The last chunk is filled up with the first entry of the table. The copies tie with that entry, which wins because its
 * index is lower. Arithmetic is per number and in the order written, so the bits are those of a plain loop. Chunks are
 * never passed by value, because the alignment of wide vectors on the stack differs between compilers.
 */
#ifndef TANDEM_SHARED_FLOAT8_H
#define TANDEM_SHARED_FLOAT8_H

#include "shared/real.h"

#define CHUNK 8u
#define FLOAT4S_OF_CHUNK 2u

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
typedef uint8 chunk_index;
#define CHUNK_CHOOSE(m, a, b) ((m) ? (a) : (b))
#define CHUNK_CHOOSE_INDEX(m, a, b) ((m) ? (a) : (b))
#define CHUNK_IOTA ((uint8)(0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u))
#define CHUNK_ALL(x) ((float8)(x))
#define CHUNK_OF(a, b, c, d, e, f, g, h) ((float8)((a), (b), (c), (d), (e), (f), (g), (h)))
#define CHUNK_STORE(to, from) vstore8(*(from), 0, (to))
#define CHUNK_LOAD(to, from, at) (*(to) = (float8)((from)[at], (from)[(at) + 1u]))
#else
#ifdef TANDEM_REFERENCE
typedef double float8 __attribute__((vector_size(64)));
typedef int64_t chunk_mask __attribute__((vector_size(64)));
typedef uint64_t chunk_index __attribute__((vector_size(64)));
#else
typedef float float8 __attribute__((vector_size(32)));
typedef int32_t chunk_mask __attribute__((vector_size(32)));
typedef uint32_t chunk_index __attribute__((vector_size(32)));
#endif
#ifdef __cplusplus
#define CHUNK_CHOOSE(m, a, b) ((m) ? (a) : (b))
#define CHUNK_CHOOSE_INDEX(m, a, b) ((m) ? (a) : (b))
#else /* C has no choice between vectors before GCC 14 */
#define CHUNK_CHOOSE(m, a, b) ((float8)(((m) & (chunk_mask)(a)) | (~(m) & (chunk_mask)(b))))
#define CHUNK_CHOOSE_INDEX(m, a, b) ((chunk_index)(((m) & (chunk_mask)(a)) | (~(m) & (chunk_mask)(b))))
#endif
#define CHUNK_IOTA \
  (chunk_index) { 0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u }
#define CHUNK_OF(a, b, c, d, e, f, g, h) ((float8){(a), (b), (c), (d), (e), (f), (g), (h)})
#define CHUNK_ALL(x) CHUNK_OF(x, x, x, x, x, x, x, x)
#define CHUNK_STORE(to, from) __builtin_memcpy((to), (from), sizeof(float8))
#define CHUNK_LOAD(to, from, at) __builtin_memcpy((to), (from) + (at), sizeof(float8))
#endif

/* The highest number in each of the eight columns, and its index. */
typedef struct {
  float8 height;
  chunk_index at;
} chunk_leader;

SHARED void load_float8(float8 *to, GLOBAL const float4 *from, uint_lanes at) { CHUNK_LOAD(to, from, at); }
SHARED void store_float8(real *to, const float8 *from) { CHUNK_STORE(to, from); }

/* The initial height is below all finite heights; a column of NaN then names the first entry. */
SHARED void start_chunk_leader(chunk_leader *best)
{
  chunk_index zero = CHUNK_IOTA - CHUNK_IOTA;
  float8 lowest = CHUNK_ALL(R(-1e30));
  best->at = zero;
  best->height = lowest;
}
/* first: index of the chunk's first number. */
SHARED void challenge_by_chunk(chunk_leader *best, const float8 *height, uint first)
{
  chunk_index at = CHUNK_IOTA + first;
  best->at = CHUNK_CHOOSE_INDEX(*height > best->height, at, best->at);
  best->height = CHUNK_CHOOSE(*height > best->height, *height, best->height);
}

/* The highest number of all columns; of equal ones, that with the lowest index. */
typedef struct {
  real height;
  uint at;
} highest_entry;

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
SHARED highest_entry highest_of_chunk(const chunk_leader *best)
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
SHARED highest_entry highest_of_chunk(const chunk_leader *best)
{
  float8 h = best->height;
  chunk_index at = best->at, none = ~(at ^ at);
  float8 turned = __builtin_shufflevector(h, h, 4, 5, 6, 7, 0, 1, 2, 3);
  h = CHUNK_CHOOSE(turned > h, turned, h);
  turned = __builtin_shufflevector(h, h, 2, 3, 0, 1, 6, 7, 4, 5);
  h = CHUNK_CHOOSE(turned > h, turned, h);
  turned = __builtin_shufflevector(h, h, 1, 0, 3, 2, 5, 4, 7, 6);
  h = CHUNK_CHOOSE(turned > h, turned, h);
  at = CHUNK_CHOOSE_INDEX(best->height == h, at, none);
  chunk_index other = __builtin_shufflevector(at, at, 4, 5, 6, 7, 0, 1, 2, 3);
  at = CHUNK_CHOOSE_INDEX(other < at, other, at);
  other = __builtin_shufflevector(at, at, 2, 3, 0, 1, 6, 7, 4, 5);
  at = CHUNK_CHOOSE_INDEX(other < at, other, at);
  other = __builtin_shufflevector(at, at, 1, 0, 3, 2, 5, 4, 7, 6);
  at = CHUNK_CHOOSE_INDEX(other < at, other, at);
  highest_entry top = {h[0], (uint)at[0]};
  return top;
}
#endif

#endif
