/* laden.h - one large body that carries many small ones, with more contacts than there are colours. */
#pragma once

#include "tests/physics/physics.h"

namespace tandem::physics_tests {

/* A slab, body 0, with side x side boxes on it, which are thrown at each other at `speed`, or rest in touch if that is
 * 0. There is no ground, so the system is closed; with gravity it falls as a whole. */
inline Scene laden_slab(int side, float restitution = 0, const Vec3 &gravity = {0, 0, 0}, float speed = 1)
{
  Scene scene = empty_scene(gravity);
  scene.materials[0].restitution = restitution;
  const float half = 0.11f * float(side);
  const float gap = speed == 0 ? 0 : 0.01f;
  add_body(scene, BodyType::dynamic, box_shape(half, 0.25f, half), {0, 0.25f, 0}).mass = 20;
  scene.shapes.push_back(box_shape(0.1f, 0.1f, 0.1f));
  for (int i = 0; i < side * side; ++i) {
    Body body;
    body.shape = uint32_t(scene.shapes.size() - 1);
    const float x = 0.22f * float(i % side) - half + 0.11f, z = 0.22f * float(i / side) - half + 0.11f;
    body.position = {x, 0.6f + gap, z};
    body.mass = 0.5f;
    /* The speeds are uneven, so that no sum is 0 by symmetry. */
    body.linear_velocity = {0.2f * speed * float(i % 3 - 1), -speed * (1 + 0.1f * float(i % 7)),
                            0.1f * speed * float(i % 5)};
    scene.bodies.push_back(body);
  }
  return scene;
}

} // namespace tandem::physics_tests
