/* self_test.h - exercises every operation that kernels may use, on one set of inputs.
 *
 * Before an OpenCL device is trusted, the host runs this source over edge values, denormals, cancelling and random
 * numbers, and compares its bits with the device's results (host/runtime/opencl/self_test.cpp, docs/exactness.md).
 * Shared code must not use an operation that is not exercised here.
 *
 * Three numbers a, b, c and two words p, q an item give one row of results.
 */
#ifndef TANDEM_SHARED_PARALLEL_SELF_TEST_H
#define TANDEM_SHARED_PARALLEL_SELF_TEST_H

#include "shared/real.h"

#define SELF_TEST_REALS(RESULT)                             \
  RESULT("addition", a + b)                                 \
  RESULT("subtraction", a - b)                              \
  RESULT("multiplication", a * b)                            \
  RESULT("division", a / b)                                 \
  RESULT("square root", square_root(a))                     \
  RESULT("square root", square_root(a * a + b * b))          \
  RESULT("contraction of a * b + c", a * b + c)              \
  RESULT("contraction of a * b - c", a * b - c)              \
  RESULT("dot product", a * b + b * c + c * a)               \
  RESULT("reciprocal", R(1.0) / a)                          \
  RESULT("reciprocal square root", R(1.0) / square_root(a)) \
  RESULT("smaller of two", choose(a < b, a, b))             \
  RESULT("larger of two", choose(a > b, a, b))              \
  RESULT("uint to float", to_real(p))                       \
  RESULT("int to float", int_to_real(p))                    \
  RESULT("conversion", to_real(p >> 8) + R(0.5) - int_to_real((uint_lanes)truncate_to_int(small)))

#define SELF_TEST_WORDS(RESULT)                                                                          \
  RESULT("comparisons", (uint)(a < b) | (uint)(a <= b) << 1 | (uint)(a > b) << 2 | (uint)(a >= b) << 3 | \
                            (uint)(a == b) << 4 | (uint)(a != b) << 5 | (uint)(a < R(0.0)) << 6)         \
  RESULT("float to int", (uint)truncate_to_int(small))                                                   \
  RESULT("32-bit integers", p * q + (p ^ q))                                                              \
  RESULT("32-bit division", p / (q | 1u) ^ p % (q | 1u))                                                 \
  RESULT("32-bit shifts", (p << (q & 31u)) ^ (q >> (p & 31u)))                                           \
  RESULT("signed integers", (uint)((int)(p >> 1) - (int)(q >> 1)))                                       \
  RESULT("64-bit product", (uint)(wide >> 32))                                                           \
  RESULT("64-bit sum", (uint)((wide + ((ulong)q << 32 | p)) >> 32))                                      \
  RESULT("64-bit division", (uint)(wide / ((ulong)q + 1u)) ^ (uint)(wide % ((ulong)p + 3u)))             \
  RESULT("64-bit shifts", (uint)((wide << (p & 31u)) >> 24) ^ (uint)(wide >> (q & 63u)))                 \
  RESULT("64-bit comparison", (uint)(wide < ((ulong)p << 32 | q)))

#define SELF_TEST_COUNT_ONE(name, expression) +1
#define SELF_TEST_REAL_COUNT (0u SELF_TEST_REALS(SELF_TEST_COUNT_ONE))
#define SELF_TEST_WORD_COUNT (0u SELF_TEST_WORDS(SELF_TEST_COUNT_ONE))

/* Totals that do not depend on the order of the items. */
enum {
  SELF_TEST_TOTAL_SUM,
  SELF_TEST_TOTAL_MAXIMUM,
  SELF_TEST_TOTAL_MINIMUM,
  SELF_TEST_TOTAL_BITS,
  SELF_TEST_TOTAL_COUNT
};

SHARED void self_test_item(GLOBAL const memory_real *numbers, GLOBAL const uint *words,
                           GLOBAL memory_real *real_results, GLOBAL uint *word_results, GLOBAL uint *totals, uint i)
{
  const real a = numbers[3u * i], b = numbers[3u * i + 1u], c = numbers[3u * i + 2u];
  const uint p = words[2u * i], q = words[2u * i + 1u];
  const real small = choose((a > R(-2.0e9)) & (a < R(2.0e9)), a, R(0.0));
  const ulong wide = (ulong)p * q;
  uint real_at = i * SELF_TEST_REAL_COUNT, word_at = i * SELF_TEST_WORD_COUNT;
#define SELF_TEST_STORE_REAL(name, expression) real_results[real_at++] = expression;
#define SELF_TEST_STORE_WORD(name, expression) word_results[word_at++] = expression;
  SELF_TEST_REALS(SELF_TEST_STORE_REAL)
  SELF_TEST_WORDS(SELF_TEST_STORE_WORD)
#undef SELF_TEST_STORE_REAL
#undef SELF_TEST_STORE_WORD
  ATOMIC_ADD(&totals[SELF_TEST_TOTAL_SUM], p);
  ATOMIC_MAX(&totals[SELF_TEST_TOTAL_MAXIMUM], q);
  ATOMIC_MIN(&totals[SELF_TEST_TOTAL_MINIMUM], p);
  ATOMIC_OR(&totals[SELF_TEST_TOTAL_BITS], p & q & (1u << (i & 31u)));
}

/* Exercises local memory and barriers: each word is combined with its mirror image and its neighbour. */
SHARED void self_test_group(GLOBAL const uint *words, GLOBAL uint *results, LOCAL uint *memory, uint group)
{
  FOR_EACH_ITEM(i, TILE) memory[i] = words[group * TILE + i];
  FOR_EACH_ITEM(i, TILE) memory[TILE + i] = memory[TILE - 1u - i] + 3u * memory[(i + 1u) % TILE];
  FOR_EACH_ITEM(i, TILE) results[group * TILE + i] = memory[TILE + (i + TILE / 2u) % TILE];
}

#endif
