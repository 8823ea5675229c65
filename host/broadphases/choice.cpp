/* choice.cpp - see choice.h. The limits are those at which the curves of `tandem bench broadphase` cross on a CPU. */
#include "host/broadphases/choice.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/shape_bounds.h"
#include "host/specialise.h"

namespace tandem {
namespace {

constexpr size_t few_bodies = 64;

} // namespace

BroadphaseChoice choose_broadphase(const Scene &scene)
{
  const size_t bodies = scene.bodies.size();
  if (bodies <= few_bodies) return {"brute-force", fmt::format("{} bodies; up to {} the fewest launches win", bodies, few_bodies)};
  const float ordinary = large_ratio * median_radius(scene);
  const auto is_large = [&](const Body &body) { return bounding_radius(scene, body) > ordinary; };
  const auto large = static_cast<size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(), is_large));
  if (large > most_large_bodies)
    return {"hybrid", fmt::format("{} of {} bodies are more than {} times as large as the median; a grid alone takes {}", large, bodies, large_ratio, most_large_bodies)};
  return {"grid", fmt::format("{} bodies, of which {} are more than {} times as large as the median", bodies, large, large_ratio)};
}

} // namespace tandem
