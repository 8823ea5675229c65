/* A wind field over all bodies: the same bits on every backend, and the speed that theory gives. */
#include <cmath>
#include <cstdio>
#include <tandem/compare.h>
#include "wind.h"

int main()
{
  tandem::Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {tandem::sphere_shape(0.1f)};
  scene.bodies.resize(1000);
  for (int i = 0; i < 1000; ++i) scene.bodies[i].position = {1.0 + i, 0, 0};
  tandem::Settings settings;
  settings.extensions = {{&wind::module(),
      [](tandem::World &world) { world.write<float>(wind::buffer::wind_whirl(), std::array{0.0f, 1.0f, 0.0f, 0.5f}); },
      {{tandem::StepPoint::forces, [](tandem::Launches &launches) { launches.run(wind::kernel::blow()); }}}}};
  tandem::World world(scene, settings, {"tbb"});
  world.step(); /* four substeps: the wind is -1 m/s along z, one metre from its axis */
  const float speed = world.bodies()[0].linear_velocity[2], expected = -1 + std::pow(1 + 0.5f / 240, -4.0f);
  std::vector<std::string> backends{"serial", "tbb:threads=2,lanes=4", "tbb"};
  try {
    tandem::World(scene, settings, {"cl"});
    backends.push_back("cl");
  } catch (const tandem::InputError &error) {
    std::printf("no device: %s\n", error.what());
  }
  const tandem::Comparison compared =
      tandem::compare_backends(scene, {.settings = settings, .backends = backends, .steps = 20});
  std::printf("speed %g m/s, expected %g; %s on %zu backends\n", speed, expected,
              compared.equal ? "EQUAL" : "DIFFERENT", backends.size());
  return std::abs(speed - expected) < 1e-6f && compared.equal ? 0 : 1;
}
