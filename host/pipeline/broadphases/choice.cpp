/* choice.cpp - see choice.h. The thresholds are where the curves of `tandem bench broadphase` cross
 * (docs/results/2026-11-22-h200-broadphase). */
#include "host/pipeline/broadphases/choice.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/scene/shape_bounds.h"
#include "host/scene/specialise.h"

namespace tandem {
namespace {

constexpr size_t few_bodies = 128, few_bodies_on_a_device = 256;

size_t large_bodies_of(const Scene &scene)
{
  const float ordinary = large_ratio * median_radius(scene);
  const auto is_large = [&](const Body &body) { return bounding_radius(scene, body) > ordinary; };
  return static_cast<size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(), is_large));
}

} // namespace

BroadphaseChoice choose_broadphase(const Scene &scene, const std::string &backend)
{
  const bool on_device = backend.starts_with("cl");
  const size_t bodies = scene.bodies.size(), few = on_device ? few_bodies_on_a_device : few_bodies;
  if (bodies <= few)
    return {Broadphase::brute_force, fmt::format("{} bodies; up to {} the fewest launches win", bodies, few)};
  if (!on_device)
    return {
        Broadphase::trees,
        fmt::format("{} bodies on a CPU, where to look again only for those that left their boxes saves most", bodies)};
  const size_t large = large_bodies_of(scene);
  const std::string sizes =
      fmt::format("{} bodies, of which {} are more than {} times as large as the median", bodies, large, large_ratio);
  if (large > most_large_bodies)
    return {Broadphase::trees, fmt::format("{}; a grid takes {} of them", sizes, most_large_bodies)};
  return {Broadphase::grid, sizes};
}

} // namespace tandem
