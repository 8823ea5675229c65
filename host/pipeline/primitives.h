/* primitives.h - the parallel primitives (scan, sort, reduce, compact) as sequences of launches, for all later stages.
 *
 * `length` is an entry of counts, read on the device. `capacity` is its upper limit, and decides only how many launches
 * are made and how large the scratch buffers are. Any length up to 2^28 works.
 */
#pragma once

#include <cstddef>
#include <cstdint>

#include <tandem/export.h>

#include "host/runtime/launcher.h"

namespace tandem {

/* Computes out[i] = in[0] + .. + in[i - 1] modulo 2^32 for i = 0 .. n, which are n + 1 results. in and out may be the
 * same buffer. sums: scan_sum_words(capacity) words of scratch. */
void exclusive_scan(Launcher &launcher, Buffer in, Buffer out, Buffer sums, uint32_t length, uint32_t capacity);
size_t scan_sum_words(size_t capacity);

/* Scans in place a table with per_unit words for each `unit` items, of which there are counts[length]; it has at most
 * as many words as items. */
void scan_table(Launcher &launcher, Buffer table, Buffer sums, uint32_t length, uint32_t unit, uint32_t per_unit,
                uint32_t capacity);

/* Stable ascending sort by bits first_bit .. last_bit - 1 of the key. The result is in keys and values; the other
 * buffers, of equal sizes, are scratch. histogram: histogram_words(capacity) words; sums:
 * scan_sum_words(histogram_words(capacity)) words. */
void sort_keys(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length,
               uint32_t capacity, unsigned first_bit, unsigned last_bit);
void sort_pairs(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values,
                Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity, unsigned first_bit,
                unsigned last_bit);
void sort_keys64(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length,
                 uint32_t capacity, unsigned first_bit, unsigned last_bit);
void sort_pairs64(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values,
                  Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity, unsigned first_bit,
                  unsigned last_bit);
size_t histogram_words(size_t capacity);

/* Sorts pairs by (key, value), ascending, in place and without scratch; used for short arrays, and as a reference for
 * tests. It makes about log2(capacity)^2 / 2 launches. */
void bitonic_sort(Launcher &launcher, Buffer keys, Buffer values, uint32_t length, uint32_t capacity);

enum class Reduction : uint32_t { sum, smallest, largest };

/* Computes result[0] = the sum (uint: modulo 2^32), smallest or largest of values; shared/parallel/reduce.h defines the
 * result for no values. partial: reduce_partial_words(capacity) elements of scratch. Reals are added in the same order
 * on every backend. */
void reduce(Launcher &launcher, Reduction reduction, Buffer values, Buffer partial, Buffer result, uint32_t length,
            uint32_t capacity);
TANDEM_API void reduce_real(Launcher &launcher, Reduction reduction, Buffer values, Buffer partial, Buffer result,
                            uint32_t length, uint32_t capacity);
TANDEM_API size_t reduce_partial_words(size_t capacity);

/* Writes the indices i with flags[i] != 0, ascending, and their number to counts[found]. offsets: capacity + 1 words of
 * scratch; sums: scan_sum_words(capacity). */
void compact(Launcher &launcher, Buffer flags, Buffer offsets, Buffer sums, Buffer indices, uint32_t length,
             uint32_t capacity, uint32_t found);

} // namespace tandem
