/* bodies.h - bodies that tests of worlds create. */
#pragma once

#include <tandem/scene.h>

namespace tandem {

/* At rest, of this shape of the scene. */
inline Body body_at(const Point &position, uint32_t shape = 0)
{
  Body body;
  body.shape = shape;
  body.position = position;
  return body;
}

} // namespace tandem
