/* pushing.h - worlds with the module `probe` (tests/module/probe_kernels.def), for its tests. */
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "probe.h"
#include "tests/host/runtime/opencl/pocl.h"

namespace module_tests {

using namespace tandem;

inline const std::vector<float> gust{0.5f, 0, -0.25f, 0}; /* m/s a substep */

inline Extension pushing(uint32_t times)
{
  return {&probe::module(),
          [](World &world) { world.write<float>(probe::buffer::probe_force(), gust); },
          {{StepPoint::forces,
            [times](Launches &launches) {
              const uint32_t values[] = {times};
              launches.run(probe::kernel::probe_push(), values);
            }},
           {StepPoint::commit, [](Launches &launches) { launches.run(probe::kernel::probe_count()); }}}};
}

inline Settings with(const Extension &extension)
{
  Settings settings;
  settings.extensions = {extension};
  return settings;
}

/* Far from each other, without gravity. */
inline Scene balls(uint32_t n)
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.1f)};
  scene.bodies.resize(n);
  for (uint32_t i = 0; i < n; ++i) scene.bodies[i].position = {2.0 * i, 0, 0};
  return scene;
}

inline std::string message_of(const std::function<void()> &work)
{
  try {
    work();
  } catch (const InputError &error) {
    return error.what();
  }
  return "nothing was refused";
}

inline std::vector<std::string> all_backends()
{
  std::vector<std::string> backends{"serial", "serial:order=backward", "tbb:threads=2,lanes=4", "tbb"};
  parity::add_pocl(backends);
  return backends;
}

} // namespace module_tests
