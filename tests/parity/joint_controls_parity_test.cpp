/* Controls of a batch have the same bits on every backend. */
#include <tandem/worlds.h>

#include "host/base/random.h"
#include "tests/parity/joints.h"
#include "tests/physics/articulate.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;

/* A chain on hinges that falls to the ground while they are driven. */
Scene driven_chain(bool in_tree)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < 5; ++i) {
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0.5 * i, 0.4 + 0.05 * i, 0});
    if (i == 0) continue;
    JointAxis &axis = connect(scene, JointType::hinge, uint32_t(i), uint32_t(i) + 1,
                              {0.5 * i - 0.25, 0.4 + 0.05 * i, 0}, Vector::UnitZ())
                          .rotations[0];
    axis.damping = 0.1f, axis.stiffness = 2, axis.lower = -2, axis.upper = 2;
  }
  if (in_tree) articulate(scene, 1);
  return scene;
}

std::vector<uint64_t> hashes_of_driven(const std::string &backend, bool in_tree, uint32_t steps, double most = 3,
                                       const Settings &settings = {})
{
  Worlds worlds(driven_chain(in_tree), 5, settings, {backend, {}, false});
  std::vector<ControlledAxis> controls;
  for (uint32_t joint = 0; joint < 4; ++joint)
    controls.push_back({joint, 3, joint % 2 ? Control::force : Control::target_position});
  worlds.choose_controls(controls);
  Random random(5);
  std::vector<float> values(5 * controls.size());
  for (uint32_t step = 0; step < steps; ++step) {
    for (float &value : values) value = float(random.uniform(-most, most));
    worlds.set_controls(values);
    worlds.step();
  }
  return worlds.state_hashes();
}

} // namespace

TEST_CASE("parity on CPU: controls of a batch have the same bits", "[articulations]")
{
  for (const bool in_tree : {false, true}) {
    const std::vector<uint64_t> serial = hashes_of_driven("serial", in_tree, 30);
    CHECK(hashes_of_driven("serial", in_tree, 30, 0) != serial);
    CHECK(serial[0] != serial[1]);
    for (const char *backend : {"tbb:threads=3", "tbb:threads=2,lanes=1", "tbb:threads=2,lanes=16"}) {
      CAPTURE(in_tree, backend);
      CHECK(hashes_of_driven(backend, in_tree, 30) == serial);
    }
  }
}

TEST_CASE("parity on PoCL: controls of a batch have the same bits", "[articulations]")
{
  require_pocl();
  CHECK(hashes_of_driven("cl:pocl", true, 6, 3, build_of_all_features()) == hashes_of_driven("serial", true, 6));
}

} // namespace tandem::parity
