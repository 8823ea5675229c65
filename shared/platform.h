/* platform.h - the one place that depends on the compiler that reads the shared source.
 *
 * Every header under shared/ is strict C99 and is compiled four ways:
 *
 *   OpenCL C   the entries in cl/        one work-item an item
 *   C++        minicl/scalar.cpp       one item at a time: gdb, serial, tails
 *   C++        minicl/lanes4.cpp ..16   4, 8 or 16 items at a time, `real` = a vector of lanes
 *   C99        the syntax check of the tests
 *
 * All of them give the same bits, because lanes never mix and because nothing below rounds differently on any of them
 * (docs/exactness.md).
 *
 * These types change with the width:
 *
 *   real      a number                      float, or one float a lane
 *   uint_lanes an unsigned 32-bit integer    uint, or one uint a lane
 *   mask      the result of a comparison    int 0/1, or all-ones/zero a lane
 *   float4    four floats in memory, 16-byte aligned; never a lane type
 *
 * Kernels marked LANES or LANES_PADDED in kernels.def, and those marked LANES_GROUP where they take what they have
 * listed, use only these types, choose() for choices that depend on data, load and store functions for memory, and
 * uniform loop counts.
 */
#ifndef TANDEM_SHARED_PLATFORM_H
#define TANDEM_SHARED_PLATFORM_H

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)

#pragma OPENCL FP_CONTRACT OFF
#define GLOBAL __global
#define LOCAL __local
#define CONSTANT_TABLE __constant
#define SHARED static inline
#define FORCE_INLINE static inline
#define CALLED SHARED

#define ATOMIC_ADD(pointer, value) atomic_add((pointer), (value))
#define ATOMIC_MAX(pointer, value) atomic_max((pointer), (value))
#define ATOMIC_MIN(pointer, value) atomic_min((pointer), (value))
#define ATOMIC_OR(pointer, value) atomic_or((pointer), (value))
#define LOCAL_ADD(pointer, value) atomic_add((pointer), (value))
#define LEADING_ZEROS(x) ((int)clz((uint)(x)))
typedef unsigned short half_word;
#define SQUARE_ROOT(x) sqrt(x)
#define FLOAT_BITS(x) as_uint(x)
#define BITS_FLOAT(x) as_float(x)

/* The phases of a work-group. The barrier stands inside the loop header, so it cannot be forgotten. A phase of a single
 * item must not hold a loop of its own, because PoCL 3.1 then runs that loop once for every item. */
#define FOR_EACH_ITEM(i, n)                                                                                  \
  for (uint i = (barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE), (uint)get_local_id(0)); i < (uint)(n); \
       i += (uint)get_local_size(0))
#define CHUNKS(many) (many)
/* A device waits for what an item reads, so loops that can read some records at once and then write them. A CPU would
 * only have more in registers than it has of these. */
#define ROWS_AT_ONCE 4u
/* And walks from record to record can read the next one while they work on this. */
#define READS_AHEAD

#else /* C or C++ on the CPU */

#include <stdint.h>
#define GLOBAL
#define LOCAL
#define CONSTANT_TABLE
#define SHARED static inline
#define CALLED SHARED /* in minicl/lanes.h a function that is not inlined */
#define ROWS_AT_ONCE 1u
/* Optimised builds inline such a function into each kernel that calls it, as devices do. A constant that a kernel
 * passes then costs nothing, and the state of a search stays in registers. A debug build keeps it a function, for
 * gdb. */
#ifdef __OPTIMIZE__
#define FORCE_INLINE static inline __attribute__((always_inline))
#else
#define FORCE_INLINE static inline
#endif
#ifndef TANDEM_SCALAR_TYPES
#define TANDEM_SCALAR_TYPES
typedef uint32_t uint;
typedef uint64_t ulong;
typedef unsigned short __attribute__((may_alias)) half_word;
#ifdef TANDEM_REFERENCE
typedef double memory_real;
typedef struct __attribute__((aligned(32))) float4 {
  memory_real x, y, z, w;
} float4;
#else
typedef float memory_real;
typedef struct __attribute__((aligned(16))) float4 {
  memory_real x, y, z, w;
} float4;
#endif

#if defined(__SSE__) && !defined(TANDEM_REFERENCE)
/* Whether the boxes from `lower` to `upper` overlap, of which w counts for nothing: two comparisons in place of six. */
#define OVERLAPS_AT_ONCE
typedef float floats_of_row __attribute__((vector_size(16), may_alias));
static inline int rows_overlap(floats_of_row lower, floats_of_row upper, const float4 *box)
{
  const floats_of_row *other = (const floats_of_row *)box;
  floats_of_row both = (floats_of_row)((lower <= other[1]) & (other[0] <= upper));
  return (__builtin_ia32_movmskps(both) & 7) == 7;
}
#endif

static inline uint float_bits(float x)
{
  uint bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  return bits;
}
static inline float float_of_bits(uint bits)
{
  float x;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}
static inline uint atomic_add_uint(uint *pointer, uint value)
{
  return __atomic_fetch_add(pointer, value, __ATOMIC_RELAXED);
}
static inline uint atomic_or_uint(uint *pointer, uint value)
{
  return __atomic_fetch_or(pointer, value, __ATOMIC_RELAXED);
}
static inline uint atomic_max_uint(uint *pointer, uint value)
{
  uint old = __atomic_load_n(pointer, __ATOMIC_RELAXED);
  while (old < value && !__atomic_compare_exchange_n(pointer, &old, value, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
  return old;
}
static inline uint atomic_min_uint(uint *pointer, uint value)
{
  uint old = __atomic_load_n(pointer, __ATOMIC_RELAXED);
  while (old > value && !__atomic_compare_exchange_n(pointer, &old, value, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
  return old;
}
static inline uint local_add_uint(uint *pointer, uint value)
{
  uint old = *pointer;
  *pointer = old + value;
  return old;
}
#endif

#define FLOAT_BITS(x) float_bits((float)(x))
#define BITS_FLOAT(x) float_of_bits(x)
#define LEADING_ZEROS(x) __builtin_clz(x)
#define ATOMIC_ADD(pointer, value) atomic_add_uint((pointer), (value))
#define ATOMIC_MAX(pointer, value) atomic_max_uint((pointer), (value))
#define ATOMIC_MIN(pointer, value) atomic_min_uint((pointer), (value))
#define ATOMIC_OR(pointer, value) atomic_or_uint((pointer), (value))
/* Local memory belongs to one thread here, so no atomic is needed. */
#define LOCAL_ADD(pointer, value) local_add_uint((pointer), (value))
#ifdef TANDEM_REFERENCE
#define SQUARE_ROOT(x) __builtin_sqrt(x)
#else
#define SQUARE_ROOT(x) __builtin_sqrtf(x)
#endif

/* One thread runs a whole phase. Test builds run it backwards, so that a race between items changes the result. */
#ifdef TANDEM_BACKWARD
#define FOR_EACH_ITEM(i, n) for (uint i = (uint)(n); i-- > 0u;)
#define CHUNKS(many) (many)
#else
#define FOR_EACH_ITEM(i, n) for (uint i = 0; i < (uint)(n); ++i)
#define CHUNKS(many) 1u
#endif

#endif

/* One group of a GROUP kernel works on TILE items, with LOCAL_WORDS words of local memory. Both are fixed, so that
 * results cannot depend on a device's group size. */
#define TILE 1024u
#define LOCAL_WORDS 8192

/* These macros are for kernels of groups:
 *   CHUNKS(many)  the number of chunks of consecutive items in a phase, one item a chunk. A work-group needs many.
 *                 One thread runs everything, so a single chunk saves it the joining. It may be used only where the
 *                 result does not depend on the cut: sums of whole numbers and ranks, never sums of reals.
 *   LOCAL_ADD     adds to a counter in local memory that other items of the phase add to as well, and returns the value
 *                 before.
 *   half_word     16 bits of local memory that another phase may read as part of a uint. */

#endif
