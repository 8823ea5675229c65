/* closest_points.h - how World::closest_points is answered: the pairs are checked, and a kernel finds the points of
 * each pair (shared/queries/closest_points.h). No structure of bodies is needed. */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tandem/bodies.h>
#include <tandem/queries.h>
#include <tandem/scene.h>

#include "host/runtime/launcher.h"
#include "host/world/body_slots.h"

namespace tandem {

using BodyPair = std::pair<BodyId, BodyId>;

/* Throws InputError that names the first entry with a stale handle, one body twice, two half-spaces, or a body in
 * quarantine, which is nowhere. */
void check_closest_points(const Scene &scene, const BodySlots &slots, std::span<const BodyPair> pairs);

/* index_of_body: from the slot of a body to its index in the body buffers. */
std::vector<ClosestPoints> closest_points(Memory &memory, Launcher &launcher, std::span<const BodyPair> pairs,
                                          const std::vector<uint32_t> &index_of_body);

} // namespace tandem
