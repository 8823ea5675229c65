/* primitives.h - the parallel primitives as sequences of launches.
 *
 * `length` is an entry of counts, read on the device; `capacity` is the most it can be, and decides only
 * how many launches are made and how large the scratch buffers are. Any length up to 2^28 works.
 */
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/launcher.h"

namespace tandem {

/* out[i] = in[0] + .. + in[i - 1] modulo 2^32, i = 0 .. n: n + 1 results. in and out may be one buffer.
 * sums: scan_sum_words(capacity) words of scratch. */
void exclusive_scan(Launcher &launcher, Buffer in, Buffer out, Buffer sums, uint32_t length, uint32_t capacity);
size_t scan_sum_words(size_t capacity);

/* Stable ascending sort by bits first_bit .. last_bit - 1 of the key. The result is in keys and values; the other
 * buffers, of equal sizes, are scratch. histogram: histogram_words(capacity) words; sums:
 * scan_sum_words(histogram_words(capacity)) words. */
void sort_keys(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity,
               unsigned first_bit, unsigned last_bit);
void sort_pairs(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values, Buffer histogram, Buffer sums,
                uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit);
void sort_keys64(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity,
                 unsigned first_bit, unsigned last_bit);
void sort_pairs64(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values, Buffer histogram,
                  Buffer sums, uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit);
size_t histogram_words(size_t capacity);

} // namespace tandem
