/* module_probe.cpp - a program with a module of its own (tests/module), for gdb to stop in one item of its kernel, and
 * with the names of its kernels and buffers asked for before main.
 *
 * Every body of the scene is pushed by 1.5 m/s along x and -0.75 m/s along z in each of four substeps, from rest. In
 * step 3 item 17 is therefore first pushed from 18 to 19.5 m/s: what a debugger must see is known without one, and the
 * library says it here, too.
 */
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string>

#include <tandem/world.h>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "probe.h"

using namespace tandem;

namespace {

/* Static objects of a program may name a module before the library's own are made. */
const Module *const module_before_main = &probe::module();
const Kernel push_before_main = probe::kernel::probe_push(), count_before_main = probe::kernel::probe_count();
const Buffer force_before_main = probe::buffer::probe_force();

constexpr uint32_t item = 17;
constexpr uint64_t step = 3;

Scene balls_at_rest()
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.1f)};
  scene.bodies.resize(40);
  for (size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].position = {2.0 * static_cast<double>(i), 0, 0};
  return scene;
}

Settings pushing()
{
  Settings settings;
  settings.extensions = {{module_before_main,
                          [](World &world) {
                            const float force[] = {0.5f, 0, -0.25f, 0};
                            world.write<float>(force_before_main, force);
                          },
                          {{StepPoint::forces, [](Launches &launches) {
                              const uint32_t times[] = {3};
                              launches.run(push_before_main, times);
                            }}}}};
  return settings;
}

bool print_velocity(World &world)
{
  const std::vector<float> v = world.memory().read<float>(Buffer::solver_velocity, 3, size_t{8} * item);
  uint32_t bits;
  std::memcpy(&bits, v.data(), sizeof bits);
  std::printf("velocity %g %g bits 0x%" PRIx32 "\n", static_cast<double>(v[0]), static_cast<double>(v[2]), bits);
  return v[0] == 19.5f && v[2] == -9.75f;
}

bool names_are_right()
{
  return module_before_main == &probe::module() && push_before_main == kernel_named("probe_push") &&
         count_before_main == kernel_named("probe_count") && force_before_main == buffer_named("probe_force") &&
         name_of(push_before_main) == std::string("probe_push");
}

} // namespace

int main()
{
  if (!names_are_right()) return std::puts("the names asked for before main are others now"), 1;
  World world(balls_at_rest(), pushing(), {"serial", {}, false});
  bool seen = false, right = false;
  world.set_observer([&](const Launch &launch) {
    if (world.statistics().steps != step || launch.kernel != push_before_main || seen) return;
    seen = true;
    right = print_velocity(world);
  });
  for (uint64_t k = 0; k <= step; ++k) world.step();
  return right ? 0 : 1;
}
