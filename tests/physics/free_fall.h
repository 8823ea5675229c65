/* free_fall.h - whether bodies without contacts move as gravity alone makes them move. */
#pragma once

#include "tests/physics/physics.h"

namespace tandem::physics_tests {

/* The largest error of the velocity of a freely moving body against gravity alone, relative to the lesser of the
 * velocities before and expected, and at least 0.1 m/s. */
inline double farthest_from_free_fall(const Scene &scene, Settings settings, double step, int steps)
{
  settings.step = float(step);
  World world(scene, settings, {"tbb", {}});
  run(world, steps);
  const std::vector<BodyState> after = world.bodies();
  double farthest = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const Body &body = scene.bodies[i];
    if (body.type != BodyType::dynamic) continue;
    const Vector before = vector_of(body.linear_velocity), expected = before + steps * step * vector_of(scene.gravity);
    const double scale = std::max(std::min(before.norm(), expected.norm()), 0.1);
    farthest = std::max(farthest, (vector_of(after[i].linear_velocity) - expected).norm() / scale);
  }
  return farthest;
}

} // namespace tandem::physics_tests
