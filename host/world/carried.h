/* carried.h - the buffers that one step hands to the next: those of buffers.def whose lifetime is STATE or CACHE.
 *
 * Each of them has two sides. The commit reads the previous side and writes the other. The host swaps the sides when
 * the commit begins, and swaps them back if the step fails; the state is then as it was, whatever the commit had
 * written by then.
 */
#pragma once

#include <vector>

#include <tandem/export.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

struct CarriedBuffer {
  Buffer now, previous;
};
/* The carried buffers of the pipeline and of all modules added so far. */
TANDEM_API std::vector<CarriedBuffer> carried_buffers();
constexpr bool is_carried(Lifetime lifetime) { return lifetime == Lifetime::STATE || lifetime == Lifetime::CACHE; }

TANDEM_API void turn_carried(Memory &memory, const std::vector<CarriedBuffer> &carried) noexcept;

/* Steps leave the rows of bodies and joints that sleep as they are, on both sides. */
bool has_rows_of_sleepers(Buffer carried);

/* The bodies of a world, and those of them that do not sleep, which come first. */
struct BodyNumbers {
  uint32_t all, awake;
};

size_t item_bytes(Buffer buffer);

/* The number of items that the last step left; later ones are of older steps. pairs: in the contact cache. */
size_t items_in_use(Memory &memory, Buffer buffer, BodyNumbers bodies, uint32_t pairs);

/* The normal impulses of pairs in rows of four, whichever of cached_single_impulse and cached_normal_impulse has them.
 * rows: empty where pairs have single points. */
std::vector<float4> impulse_rows(const std::vector<float> &single, std::vector<float4> rows);

/* A hash of these buffers, as far as a scene of these features has them. If nobody sleeps, it is equal iff the next
 * step will be equal. */
uint64_t hash_carried(Memory &memory, const std::vector<CarriedBuffer> &carried, BodyNumbers bodies, Features features);

} // namespace tandem
