/* bodies.h - bodies that tests of worlds create, and settings of such worlds. */
#pragma once

#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

/* At rest, of this shape of the scene. */
inline Body body_at(const Point &position, uint32_t shape = 0)
{
  Body body;
  body.shape = shape;
  body.position = position;
  return body;
}

inline Settings sleepy()
{
  Settings settings;
  settings.sleeping = true;
  return settings;
}

} // namespace tandem
