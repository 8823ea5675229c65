/* primitives.h - the parallel primitives as sequences of launches.
 *
 * `length` is an entry of counts, read on the device; `capacity` is the most it can be, and decides only
 * how many launches are made.
 */
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/launcher.h"

namespace tandem {

/* out[i] = in[0] + .. + in[i - 1], i = 0 .. n: n + 1 results. in and out may be one buffer. */
void exclusive_scan(Launcher &launcher, Buffer in, Buffer out, Buffer sums, uint32_t length, uint32_t capacity);
size_t scan_sum_words(size_t capacity);

/* Stable ascending sort by bits first_bit .. last_bit - 1; the result is in keys and values. */
void sort_pairs(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values, Buffer histogram, Buffer sums,
                uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit);
void sort_keys64(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity,
                 unsigned first_bit, unsigned last_bit);
size_t histogram_words(size_t capacity);

} // namespace tandem
