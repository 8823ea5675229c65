/* buffer_location.h - the meaning of one number inside a buffer: its item, field and value.
 *
 * Buffers are flat arrays, and buffers.def describes the layout of an item in them. The comparison of backends
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

/* Numbers are counted in scalars: a float4 is four of them. */
size_t scalar_bytes(Buffer buffer);

/* `capacity`: the number of items that fit, which is the stride of planes. */
BufferLocation location_in(Buffer buffer, size_t scalar, size_t capacity);

/* One number in decimal and as its bits. */
BufferValue value_at(Buffer buffer, const void *scalar);

/* The number of floats between the two, 0 only for equal bits; nothing for integers and NaN. */
std::optional<uint64_t> ulps_between(Buffer buffer, const void *one, const void *other);

/* True for equal bits, or if both are NaN: the sign and payload of a NaN that a processor makes depend on the order of
 * the operands, which the compiler chooses (docs/exactness.md). */
bool same_number(Buffer buffer, const void *one, const void *other);

bool holds_reals(Buffer buffer); /* float4s or reals, not integers */

/* Equal for two buffers in which all numbers are the same. */
uint64_t hash_numbers(Buffer buffer, const void *contents, size_t bytes);

/* Makes the smallest change: to the next float away from zero, or of an integer's last bit. */
void change_least(Buffer buffer, void *scalar);

} // namespace tandem
