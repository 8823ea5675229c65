/* choice.cpp - see choice.h. The thresholds are where the curves of `tandem bench broadphase` cross
 * (docs/results/2026-11-22-h200-broadphase for devices, docs/results/2026-11-26-broadphase-choice for CPUs). */
#include "host/pipeline/broadphases/choice.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/runtime/interface/kernel_list.h"
#include "host/scene/shape_bounds.h"
#include "host/scene/specialise.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

constexpr size_t few_bodies = 64, few_bodies_on_a_device = 128;

bool is_device(const std::string &backend) { return backend.starts_with("cl"); }

/* The most bodies for brute force. */
size_t few_on(const std::string &backend, std::optional<Broadphase> before)
{
  const size_t few = is_device(backend) ? few_bodies_on_a_device : few_bodies;
  return before.value_or(Broadphase::brute_force) == Broadphase::brute_force ? few : few / 2;
}

size_t large_bodies_of(const Scene &scene)
{
  const float ordinary = large_ratio * median_radius(scene);
  const auto is_large = [&](const Body &body) { return bounding_radius(scene, body) > ordinary; };
  return static_cast<size_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(), is_large));
}

} // namespace

BroadphaseChoice choose_broadphase(const Scene &scene, const std::string &backend)
{
  return choose_broadphase(scene, scene.bodies.size(), backend, BroadphaseHistory{});
}

BroadphaseChoice choose_broadphase(const Scene &scene, size_t bodies, const std::string &backend,
                                   const BroadphaseHistory &history)
{
  if (const size_t few = few_on(backend, history.before); bodies <= few)
    return {Broadphase::brute_force, fmt::format("{} bodies; up to {} the fewest launches win", bodies, few)};
  if (!is_device(backend) && !history.moving)
    return {
        Broadphase::trees,
        fmt::format("{} bodies on a CPU, where to look again only for those that left their boxes saves most", bodies)};
  const size_t large = large_bodies_of(scene);
  const std::string sizes = fmt::format("{} bodies{}, of which {} are more than {} times as large as the median",
                                        bodies, history.moving ? " that keep moving" : "", large, large_ratio);
  if (large > most_large_bodies)
    return {Broadphase::trees, fmt::format("{}; a grid takes {} of them", sizes, most_large_bodies)};
  return {Broadphase::grid, sizes};
}

bool is_still_right(Broadphase broadphase, size_t bodies, const std::string &backend)
{
  return (bodies <= few_on(backend, broadphase)) == (broadphase == Broadphase::brute_force);
}

void TreesTrial::note_step(bool with_trees, bool rebuilt, double pairs_of_body)
{
  if (pause_ > 0 && (pairs_of_body > dense_crowd || --pause_ == 0)) {
    pause_ = 0;
    since_rebuilt_ = quiet;
  }
  if (!with_trees) return;
  if (rebuilt && since_rebuilt_ < quiet && pairs_of_body <= crowd) {
    pause_ = next_pause_;
    next_pause_ = std::min(2 * next_pause_, longest_pause);
  }
  since_rebuilt_ = rebuilt ? 0 : since_rebuilt_ + 1;
  if (since_rebuilt_ > 4 * quiet) next_pause_ = first_pause;
}

uint32_t query_structure_for(Broadphase chosen, size_t bodies, const std::string &backend)
{
  const bool few = bodies <= few_on(backend, std::nullopt);
  return chosen == Broadphase::brute_force && !few ? uint32_t{QUERY_HIERARCHY} : row_of(chosen).queries;
}

const std::string &broadphase_backend(const Placement &placement)
{
  if (!placement.broadphase_for.empty()) return placement.broadphase_for;
  const std::string *backend = &placement.on;
  for (const auto &[what, where] : placement.exceptions)
    if (what == name_of(Stage::broadphase)) backend = &where;
  return *backend;
}

} // namespace tandem
