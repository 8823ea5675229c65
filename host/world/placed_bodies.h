/* placed_bodies.h - puts bodies into a scene, and takes them out again unless they are kept: what comes after may lack
 * memory, and a call takes effect completely or not at all. */
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tandem/scene.h>

#include "host/base/reserve_more.h"

namespace tandem {

class PlacedBodies {
public:
  /* Slots within the scene are replaced; those past its end are in ascending order. */
  PlacedBodies(Scene &scene, std::span<const uint32_t> slots, std::span<const Body> bodies)
      : scene_(scene), count_(scene.bodies.size())
  {
    replaced_.reserve(bodies.size());
    reserve_more(scene.bodies, bodies.size());
    for (size_t i = 0; i < bodies.size(); ++i) put(slots[i], bodies[i]);
  }
  ~PlacedBodies()
  {
    if (kept_) return;
    for (auto one = replaced_.rbegin(); one != replaced_.rend(); ++one)
      std::swap(scene_.bodies[one->first], one->second);
    scene_.bodies.resize(count_);
  }
  PlacedBodies(const PlacedBodies &) = delete;
  PlacedBodies &operator=(const PlacedBodies &) = delete;
  void keep() noexcept { kept_ = true; }

private:
  void put(uint32_t slot, Body body)
  {
    if (slot >= scene_.bodies.size()) return scene_.bodies.push_back(std::move(body));
    replaced_.emplace_back(slot, std::move(body));
    std::swap(scene_.bodies[slot], replaced_.back().second);
  }

  Scene &scene_;
  size_t count_;
  std::vector<std::pair<uint32_t, Body>> replaced_;
  bool kept_ = false;
};

} // namespace tandem
