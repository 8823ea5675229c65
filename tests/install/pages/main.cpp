/* The examples of docs/worlds.md and docs/recordings.md, each as it stands there, in an order in which they can run.
 * Prints what the one that ends with an error says. */
#include <cstdio>

#include <tandem/world.h>

using namespace tandem;

int main()
{
  Scene scene;
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f)};
  scene.bodies.resize(2);
  scene.bodies[0].type = BodyType::fixed;
  scene.bodies[1].position = {0, 1, 0};
  World world(scene);
  try {
#include "worlds_1.inc"
  } catch (const InputError &error) {
    std::puts(error.what());
  }
  {
#include "worlds_2.inc"
  }
  {
#include "worlds_3.inc"
  }
  {
#include "recordings_1.inc"
  }
  {
#include "recordings_2.inc"
  }
  {
#include "recordings_3.inc"
  }
}
