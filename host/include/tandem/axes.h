/* axes.h - a choice among the axes x, y, z: of the world for locks of bodies, of a frame for joints. */
#pragma once

namespace tandem {

struct Axes {
  bool x = false, y = false, z = false;
  friend bool operator==(const Axes &, const Axes &) = default;
};

} // namespace tandem
