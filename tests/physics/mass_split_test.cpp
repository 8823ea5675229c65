/* Mass splitting, which solves constraints at the same time: momentum is kept after any number of iterations, a plate
 * under many spheres separates from them as theory predicts, and the overflow constraints of a laden body carry its
 * load. */
#include "host/runtime/interface/kernel_list.h"
#include "tests/catch.h"
#include "tests/physics/laden.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

struct MomentumDrift {
  double linear = 0, angular = 0;
};

/* In a closed system, relative to the sum of the lengths. */
MomentumDrift momentum_drift(const Scene &scene, const Settings &settings, const std::string &backend, int steps)
{
  World world(scene, settings, {backend, {}, false});
  const Momentum start = momentum_of(world);
  MomentumDrift drift;
  for (int step = 0; step < steps; ++step) {
    world.step();
    const Momentum now = momentum_of(world);
    drift.linear = std::max(drift.linear, (now.linear - start.linear).norm() / start.linear_scale);
    drift.angular = std::max(drift.angular, (now.angular - start.angular).norm() / start.angular_scale);
  }
  CHECK(world.statistics().contacts > uint32_t(scene.bodies.size()) / 2);
  return drift;
}

} // namespace

TEST_CASE("a body of very many constraints keeps momentum", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::jacobi, Solver::pgs, Solver::nncg, Solver::direct);
  const float restitution = GENERATE(0.0f, 0.5f);
  const int side = GENERATE(12, 36);
  const MomentumDrift drift =
      momentum_drift(laden_slab(side, restitution), settings_for(solver), "tbb", side == 12 ? 30 : 6);
  INFO(name_of(solver) << ", " << side * side << " boxes, restitution " << restitution << ": momentum " << drift.linear
                       << ", angular " << drift.angular);
  CHECK(drift.linear < 1e-5);
  CHECK(drift.angular < 1e-5);
}

/* n spheres of mass m fall at the same speed u on a free plate of mass M: one inelastic impact, v = n m u / (n m + M).
 * (The soft step lets colours push one after the other, so the first to be solved overshoot and part.) */
TEST_CASE("spheres that land on a free plate at once move on with it", "[physics]")
{
  const float plate_mass = GENERATE(2.0f, 200.0f);
  constexpr int side = 10;
  constexpr double mass = 0.5, speed = 2;
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(3, 0.25f, 3), {0, 0, 0}).mass = plate_mass;
  scene.shapes.push_back(sphere_shape(0.2f));
  for (int i = 0; i < side * side; ++i) {
    Body body;
    body.shape = 1;
    body.mass = float(mass);
    body.position = {0.5f * float(i % side) - 2.25f, 0.47f, 0.5f * float(i / side) - 2.25f};
    body.linear_velocity = {0, float(-speed), 0};
    scene.bodies.push_back(body);
  }
  World world(scene, settings_for(Solver::jacobi));
  run(world, 20);
  const double joint = side * side * mass * -speed / (side * side * mass + plate_mass);
  double worst = 0;
  for (const BodyState &state : world.bodies()) worst = std::max(worst, std::abs(state.linear_velocity[1] - joint));
  INFO("plate of " << plate_mass << " kg: expected " << joint << " m/s, worst off by " << worst);
  CHECK(worst < 0.02 * speed);
}

/* Twenty by twenty boxes of ten times the mass of the slab on it, on the ground. With the overflow constraints solved
 * in order by one item they sank in by 6.1 mm and never came to rest. */
TEST_CASE("overflow constraints carry their load at rest", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::pgs, Solver::nncg, Solver::xpbd, Solver::direct);
  Scene scene = laden_slab(20, 0, {0, -10, 0}, 0);
  add_ground(scene);
  World world(scene, settings_for(solver));
  const std::vector<BodyState> start = world.bodies();
  run(world, 90);
  CHECK(world.statistics().colors == COLOR_LIMIT + 1);
  CHECK(world.statistics().max_penetration < 0.0061);
  CHECK(world.statistics().kinetic_energy < 1e-6);
  double moved = 0;
  const std::vector<BodyState> now = world.bodies();
  for (size_t i = 0; i < now.size(); ++i)
    moved = std::max(moved, (vector_of(now[i].position) - vector_of(start[i].position)).norm());
  INFO(name_of(solver) << ", 400 boxes on a slab: moved " << moved << " m, penetration "
                       << world.statistics().max_penetration);
  CHECK(moved < 0.02);
}

TEST_CASE("kernels and buffers of the overflow constraints come with them")
{
  const auto runs = [](World &world, Kernel kernel) {
    const std::vector<Kernel> kernels = world.kernels();
    return std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
  };
  World laden(laden_slab(12)), light(laden_slab(5));
  for (World *world : {&laden, &light}) {
    CHECK_FALSE(runs(*world, Kernel::split_solve));
    run(*world, 4);
  }
  CHECK(laden.statistics().colors == COLOR_LIMIT + 1);
  CHECK(runs(laden, Kernel::split_solve));
  CHECK_FALSE(runs(light, Kernel::split_solve));
}
