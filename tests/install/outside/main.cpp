/* A project of someone else: a ball falls for a second, with nothing but find_package(Tandem). */
#include <cmath>
#include <iostream>

#include <tandem/scene.h>
#include <tandem/world.h>

int main()
{
  tandem::Scene scene;
  scene.shapes.push_back({tandem::ShapeType::sphere, {0.5f, 0, 0}});
  tandem::Body ball;
  ball.name = "ball";
  ball.position = {0, 10, 0};
  scene.bodies.push_back(ball);
  tandem::validate(scene, "outside");
  tandem::World world(scene, {}, {"serial", {}});
  for (int i = 0; i < 60; ++i) world.step();
  const float height = world.bodies()[0].position[1];
  std::cout << "height after one second: " << height << " m\n";
  /* y = 10 - g t^2 / 2, to which the integrator adds only rounding. */
  return std::abs(height - 5.0f) < 1e-3f ? 0 : 1;
}
