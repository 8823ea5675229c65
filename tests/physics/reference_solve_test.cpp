/* The reference solves contact problems as an independent solver does: a column of balls of different masses and random
 * speeds, whose impulses are found by dense solves (Eigen) for all sets of active contacts.
 *
 *   o  m3, v3      u = A p + J (v + h g),  A = J M^-1 J^T,  p >= 0, u >= 0, p u = 0
 *   o  m2, v2      one contact below each ball; of 2^n sets exactly one satisfies the signs, for A is positive definite
 *   o  m1, v1
 *  ---- ground
 */
#include <Eigen/Dense>

#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Numbers = Eigen::VectorXd;

struct Column {
  Numbers mass, speed; /* upwards */
};

Column random_column(Random &random, int n)
{
  Column column{Numbers(n), Numbers(n)};
  for (int k = 0; k < n; ++k)
    column.mass[k] = float(random.uniform(0.5, 5)), column.speed[k] = float(random.uniform(-3, 2));
  return column;
}

/* Speeds after the impact, by trying every set of active contacts. */
Numbers solve_by_enumeration(const Column &column, double step)
{
  const int n = int(column.mass.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(n, n);
  for (int k = 1; k < n; ++k) jacobian(k, k - 1) = -1;
  const Numbers inverse_mass = column.mass.cwiseInverse(), free = column.speed - Numbers::Constant(n, gravity * step);
  const Eigen::MatrixXd response = jacobian * inverse_mass.asDiagonal() * jacobian.transpose();
  const Numbers apart = jacobian * free;
  for (unsigned set = 0; set < 1u << n; ++set) {
    std::vector<int> active;
    for (int k = 0; k < n; ++k)
      if (set >> k & 1) active.push_back(k);
    Numbers impulse = Numbers::Zero(n);
    if (!active.empty()) {
      const Eigen::MatrixXd own = response(active, active);
      const Numbers right = -apart(active), solved = own.ldlt().solve(right);
      impulse(active) = solved;
    }
    const Numbers speeds = response * impulse + apart;
    if (impulse.minCoeff() >= -1e-12 && speeds.minCoeff() >= -1e-12)
      return free + inverse_mass.cwiseProduct(jacobian.transpose() * impulse);
  }
  FAIL("no set of active contacts solves the problem");
  return free;
}

Numbers solve_by_reference(const Column &column, double step)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int k = 0; k < column.mass.size(); ++k) {
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0.5f + float(k), 0});
    ball.mass = float(column.mass[k]);
    ball.linear_velocity = {0, float(column.speed[k]), 0};
  }
  Settings settings = settings_with(step, 1);
  settings.iterations = 1000;
  World world(scene, settings, {"reference", {}, false});
  world.step();
  Numbers speeds(column.mass.size());
  for (int k = 0; k < speeds.size(); ++k) speeds[k] = world.precise_bodies()[size_t(k) + 1].linear_velocity[1];
  return speeds;
}

} // namespace

TEST_CASE("reference: impacts in a column agree with an independent dense solve", "[physics][reference]")
{
  Random random(11);
  int parted = 0, pressed = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Column column = random_column(random, 1 + trial % 5);
    const double step = 1.0 / 1024;
    const Numbers expected = solve_by_enumeration(column, step), found = solve_by_reference(column, step);
    CAPTURE(trial, column.mass.transpose(), column.speed.transpose(), expected.transpose(), found.transpose());
    CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-7); /* masses are inverted in float */
    (expected.cwiseAbs().maxCoeff() > 1e-3 ? parted : pressed) += 1;
  }
  CHECK(parted > 5); /* both kinds occur, or the test says little */
  CHECK(pressed > 2);
}
