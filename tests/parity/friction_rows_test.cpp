/* friction_rows_test.cpp - a scene without friction has no rows of it, whatever the solver, and the bits of a world
 * that has them all the same. */
#include <cmath>

#include "host/pipeline/solvers/solvers.h"
#include "host/runtime/interface/features.h"
#include "host/runtime/memory.h"
#include "host/world/forced_features.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

constexpr int friction_steps = 40;

/* Columns of boxes and balls, whose normals lie along the axes, and boxes that fall on them as they turn. */
Scene half_smooth_pile(float friction)
{
  Scene scene;
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.5f)};
  scene.materials.resize(2);
  for (Material &material : scene.materials) material.static_friction = material.dynamic_friction = 0;
  scene.materials[1].static_friction = scene.materials[1].dynamic_friction = friction;
  Body ground;
  ground.type = BodyType::fixed;
  scene.bodies.push_back(ground);
  for (uint32_t k = 0; k < 27; ++k) {
    Body body;
    body.shape = k < 9 ? 1 : 1 + k % 2;
    body.material = k % 2;
    body.position = {1.0 * (k % 3), 0.5 + k / 9, 1.0 * (k / 3 % 3)};
    scene.bodies.push_back(body);
  }
  for (uint32_t k = 0; k < 4; ++k) {
    Body box;
    box.shape = 1;
    box.position = {0.7 * k, 4.0 + k, 0.3 * k};
    box.linear_velocity = {0.4f, -3, 0.1f};
    box.angular_velocity = {1, float(k), -2};
    scene.bodies.push_back(box);
  }
  return scene;
}

bool has_rows_of(World &world, Buffer buffer) { return world.memory().bytes(buffer) > 0; }

std::vector<uint64_t> hashes_of_steps(World &world)
{
  std::vector<uint64_t> hashes;
  for (int k = 0; k < friction_steps; ++k) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

} // namespace

TEST_CASE("parity on CPU: a scene without friction has no rows of it, and the bits of a world that has", "[sanitizer]")
{
  for (const SolverRow &solver : solvers()) {
    const Settings settings = settings_for(solver.choice);
    for (const char *backend : {"serial", "tbb:threads=2,lanes=8"}) {
      CAPTURE(solver.name, backend);
      World without(half_smooth_pile(0), settings, {backend, {}});
      const auto with = world_with_features(half_smooth_pile(0), settings, {backend, {}}, FEATURE_FRICTION);
      CHECK(hashes_of_steps(without) == hashes_of_steps(*with));
      CHECK(without.statistics().contacts > 0);
      for (const Buffer rows : {Buffer::constraint_friction_impulse, Buffer::cached_friction_impulse,
                                Buffer::previous_cached_friction_impulse}) {
        CHECK(!has_rows_of(without, rows));
        CHECK(has_rows_of(*with, rows));
      }
    }
  }
}

TEST_CASE("parity on OpenCL: a scene without friction has the bits of the CPU, whatever the solver")
{
  require_pocl();
  for (const SolverRow &solver : solvers()) {
    const Settings settings = settings_for(solver.choice);
    CAPTURE(solver.name);
    World device(half_smooth_pile(0), settings, {"cl:pocl", {}}), serial(half_smooth_pile(0), settings, {"serial", {}});
    for (int k = 0; k < 10; ++k) {
      device.step();
      serial.step();
    }
    CHECK(device.state_hash() == serial.state_hash());
  }
}

TEST_CASE("contacts without friction in a scene with friction keep positive zeros, however their bodies turn")
{
  World world(half_smooth_pile(0.5f), {}, {"serial", {}});
  uint32_t smooth = 0;
  for (int k = 0; k < friction_steps; ++k) {
    world.step();
    const auto counts = world.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    const uint32_t constraints = counts[COUNT_CONSTRAINTS];
    const auto normals = world.memory().read<float>(Buffer::constraint_normal, 4 * constraints);
    const auto impulses = world.memory().read<float>(Buffer::constraint_friction_impulse, 4 * constraints);
    for (uint32_t i = 0; i < constraints; ++i) {
      const float packed = normals[4 * i + 3]; /* packed_friction of shared/setup/contact.h */
      if (packed != 0 && packed != -1) continue;
      ++smooth;
      for (uint32_t k = 0; k < 3; ++k) REQUIRE((impulses[4 * i + k] == 0 && !std::signbit(impulses[4 * i + k])));
    }
  }
  CHECK(smooth > 100);
}

/* Rows that come in are zeros; a world that had them all the time has the zeros of smooth contacts there. */
TEST_CASE("parity on CPU: a scene that gains friction goes on with the bits of all features", "[sanitizer]")
{
  for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::xpbd, Solver::jacobi}) {
    Settings settings = settings_for(solver), everything = settings;
    everything.specialise = false;
    World world(half_smooth_pile(0), settings, {"serial", {}}), whole(half_smooth_pile(0), everything, {"serial", {}});
    CAPTURE(row_of(solver).name);
    for (World *one : {&world, &whole}) {
      for (int k = 0; k < 20; ++k) one->step();
      Material rough;
      rough.static_friction = rough.dynamic_friction = 0.8f;
      const uint32_t material = one->add_material(rough);
      for (uint32_t body = 0; body < one->scene().bodies.size(); body += 2)
        one->set_material(one->id_of(body), material);
    }
    CHECK(hashes_of_steps(world) == hashes_of_steps(whole));
    CHECK(has_rows_of(world, Buffer::cached_friction_impulse));
  }
}

TEST_CASE("a world without friction is saved and restored, and goes on with the same bits")
{
  for (const Solver solver : {Solver::soft_step, Solver::xpbd, Solver::avbd}) {
    World world(half_smooth_pile(0), settings_for(solver));
    for (int k = 0; k < 20; ++k) world.step();
    World restored(world.save());
    CHECK(restored.state_hash() == world.state_hash());
    CHECK(!has_rows_of(restored, Buffer::cached_friction_impulse));
    CHECK(hashes_of_steps(restored) == hashes_of_steps(world));
  }
}

TEST_CASE("parity on CPU: only soft-step keeps the warm starts of substeps, and the others have the same bits")
{
  for (const SolverRow &solver : solvers()) {
    const Settings settings = settings_for(solver.choice);
    CAPTURE(solver.name);
    World world(half_smooth_pile(0.5f), settings, {"tbb:threads=2,lanes=4", {}});
    const auto keeping = world_with_features(half_smooth_pile(0.5f), settings, {"tbb:threads=2,lanes=4", {}},
                                             FEATURE_SUBSTEP_WARM_START);
    CHECK(hashes_of_steps(world) == hashes_of_steps(*keeping));
    CHECK(has_rows_of(world, Buffer::warm_start_impulse) == (solver.choice == Solver::soft_step));
    CHECK(has_rows_of(*keeping, Buffer::warm_start_impulse));
  }
}
