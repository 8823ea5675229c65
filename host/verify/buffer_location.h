/* buffer_location.h - what one number inside a buffer means: whose it is, which field, which value.
 *
 * Buffers are flat arrays; buffers.def knows how an item lies in them. The comparison of backends
 * (tandem/compare.h) uses this to turn "word 8193 differs" into "constraint 17, plane 2, separation".
 *
 *   records:  item 0: row 0, row 1 | item 1: row 0, row 1 | ...
 *   planes:   row 0 of items 0 .. capacity - 1 | row 1 of items 0 .. capacity - 1 | ...
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tandem/compare.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

/* Numbers are counted in scalars: a row is four of them. */
size_t scalar_bytes(Buffer buffer);

/* `capacity`: items there is room for, the stride of planes. */
BufferLocation location_in(Buffer buffer, size_t scalar, size_t capacity);

/* One number as its bytes say. */
BufferValue value_at(Buffer buffer, const void *scalar);

/* How many floats lie between the two, 0 only for equal bits; nothing for integers and NaN. */
std::optional<uint64_t> ulps_between(Buffer buffer, const void *one, const void *other);

/* Equal bits, or both not a number: processors choose the sign and payload of a NaN that they make by the order of
 * the operands, which is the compiler's (docs/exactness.md). */
bool same_number(Buffer buffer, const void *one, const void *other);

bool holds_reals(Buffer buffer); /* rows or reals, not whole numbers */

/* Equal for two buffers of which every number is the same. */
uint64_t hash_numbers(Buffer buffer, const void *contents, size_t bytes);

/* The smallest change: the float next to it away from zero; an integer's last bit. */
void change_least(Buffer buffer, void *scalar);

} // namespace tandem
