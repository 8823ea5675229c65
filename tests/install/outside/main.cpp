/* An external project in which a ball falls for a second, with nothing but find_package(Tandem). */
#include <cmath>
#include <iostream>

#include <tandem/scene.h>
#include <tandem/settings.h>
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
  tandem::Settings settings = tandem::settings_for(tandem::Solver::pgs);
  settings.broadphase = tandem::parse_setting<tandem::Broadphase>("brute-force");
  tandem::World world(scene, settings, {"serial", {}});
  for (int i = 0; i < 60; ++i) world.step();
  const float height = world.bodies()[0].position[1];
  std::cout << "height after one second, by " << tandem::name_of(settings.solver) << ": " << height << " m\n";
  /* y = 10 - g t^2 / 2, to which the integrator adds only rounding. */
  return std::abs(height - 5.0f) < 1e-3f ? 0 : 1;
}
