/* An application may set flush-to-zero or another rounding mode on any thread, before a world is made or while it
 * lives. The bits must not change, and the application's setting must stay. */
#include <tandem/worlds.h>

#include "tests/parity/parity.h"

#if defined(__x86_64__)
#include <chrono>
#include <thread>

#include <immintrin.h>
#include <tbb/parallel_for.h>

using namespace tandem;
using namespace tandem::parity;

namespace {

constexpr unsigned usual = 0x1f80, flushes_to_zero = 0x9fc0, rounds_to_zero = 0x7f80, rounds_up = 0x5f80;

class ControlWord {
public:
  explicit ControlWord(unsigned word) : saved_(_mm_getcsr()) { _mm_setcsr(word); }
  ~ControlWord() { _mm_setcsr(saved_); }
  ControlWord(const ControlWord &) = delete;
  ControlWord &operator=(const ControlWord &) = delete;

private:
  unsigned saved_;
};

/* Sets the mode on each worker, as an application does once. */
void set_on_workers(unsigned word)
{
  tbb::parallel_for(0, 64, [word](int) {
    std::this_thread::sleep_for(std::chrono::microseconds(20)); /* so that no worker takes all */
    _mm_setcsr(word);
  });
}

/* A sphere that drifts by denormal distances beside others that collide: flushing and rounding both would show. */
Scene drifting_scene()
{
  Scene scene = load_scene("spheres:n=300,height=0,restitution=0.3");
  scene.gravity = {0, -10, 0};
  Body drifter = scene.bodies.back();
  drifter.position = {0, 1e-39f, 50};
  drifter.linear_velocity = {2e-39f, 0, 0};
  drifter.gravity_factor = 0;
  scene.bodies.push_back(drifter);
  return scene;
}

uint64_t run_under(const Scene &scene, const std::string &backend, unsigned at_start, unsigned at_steps)
{
  const ControlWord start(at_start);
  World world(scene, {}, Placement{backend, {}, false});
  const ControlWord steps(at_steps);
  set_on_workers(at_steps);
  for (int k = 0; k < 20; ++k) world.step();
  CHECK((_mm_getcsr() & ~0x3fu) == (at_steps & ~0x3fu));
  return world.state_hash();
}

void require_indifference(const std::string &backend)
{
  const Scene scene = drifting_scene();
  const uint64_t expected = run_under(scene, backend, usual, usual);
  for (const unsigned word : {flushes_to_zero, rounds_to_zero, rounds_up}) {
    CAPTURE(backend, word);
    CHECK(run_under(scene, backend, usual, word) == expected);
    CHECK(run_under(scene, backend, word, word) == expected);
  }
}

} // namespace

TEST_CASE("parity on CPU: numbers that controls set do not depend on the settings of floating point")
{
  constexpr uint32_t count = 700;
  Scene scene;
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies.resize(1);
  Joint rail;
  rail.type = JointType::slider;
  rail.body_b = 0;
  rail.directions[0].damping = 0.1f;
  scene.joints = {rail};
  scene.actuators = {{.name = "cart", .joint = 0, .axis = 0, .offset = 0.1f, .factor = 0.3f}};
  std::vector<float> controls(count);
  for (uint32_t world = 0; world < count; ++world) controls[world] = 0.001f * float(world);
  const auto hashes_under = [&](unsigned word) {
    const ControlWord mode(word);
    set_on_workers(word);
    Worlds worlds(scene, count, {}, {"tbb:threads=2", {}});
    worlds.choose_controls(worlds.scene(0).actuators);
    worlds.set_controls(controls);
    World world(scene, {}, {"serial", {}});
    world.set_controls(std::vector<float>{controls[333]});
    worlds.step();
    world.step();
    CHECK(worlds.bodies(333)[0].linear_velocity == world.bodies()[0].linear_velocity);
    return worlds.state_hashes();
  };
  const std::vector<uint64_t> expected = hashes_under(usual);
  CHECK(expected[1] != expected[2]);
  for (const unsigned word : {flushes_to_zero, rounds_to_zero, rounds_up}) {
    CAPTURE(word);
    CHECK(hashes_under(word) == expected);
  }
  set_on_workers(usual);
}

TEST_CASE("parity on CPU: the settings of floating point under test have effect")
{
  volatile float tiny = 2e-39f, one = 1.0f, third = 3.0f;
  const float exact = one / third;
  {
    const ControlWord word(flushes_to_zero);
    CHECK(tiny * one == 0.0f);
  }
  const ControlWord word(rounds_to_zero);
  CHECK(one / third != exact);
}

TEST_CASE("parity on CPU: floating-point settings of the application")
{
  for (const char *backend : {"serial", "tbb:threads=4,lanes=1", "tbb:threads=4"}) require_indifference(backend);
}

TEST_CASE("parity on OpenCL: floating-point settings of the application")
{
  require_pocl();
  require_indifference("cl:pocl");
}
#endif
