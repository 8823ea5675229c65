/* Contact problems of random points: converged solutions satisfy the contact laws, and no other result is ever
 * returned. */
#include <cmath>

#include <Eigen/Dense>

#include "host/base/random.h"
#include "host/pipeline/solvers/island_solver.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

Eigen::MatrixXd random_matrix(Random &random, int rows, int columns)
{
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) m(i, k) = random.uniform(-1, 1);
  return m;
}

/* Manifolds of four points over bodies of `degrees` freedoms in all; masses over two decades. */
IslandProblem random_problem(Random &random, int manifolds, int degrees, double friction)
{
  const int rows = 7 * manifolds;
  const Eigen::MatrixXd jacobian = random_matrix(random, rows, degrees);
  Eigen::VectorXd inverse_mass(degrees);
  for (int k = 0; k < degrees; ++k) inverse_mass[k] = std::pow(10, random.uniform(-1, 1));
  const Eigen::MatrixXd matrix = jacobian * inverse_mass.asDiagonal() * jacobian.transpose();
  const Eigen::VectorXd offset = jacobian * random_matrix(random, degrees, 1);
  IslandProblem problem;
  problem.rows = uint32_t(rows);
  problem.matrix.assign(matrix.data(), matrix.data() + matrix.size());
  problem.offset.assign(offset.data(), offset.data() + rows);
  problem.impulse.assign(size_t(rows), 0.0);
  for (int m = 0; m < manifolds; ++m) problem.manifolds.push_back({uint32_t(7 * m), 4, true, true, friction, 0.3});
  return problem;
}

IslandResult solve(IslandProblem &problem)
{
  Arena arena;
  arena.reserve(island_solver_bytes(problem.rows));
  return solve_island(problem, arena);
}

Eigen::VectorXd speeds_of(const IslandProblem &problem)
{
  const Eigen::Index n = problem.rows;
  const Eigen::Map<const Eigen::MatrixXd> matrix(problem.matrix.data(), n, n);
  return matrix * Eigen::Map<const Eigen::VectorXd>(problem.impulse.data(), n) +
         Eigen::Map<const Eigen::VectorXd>(problem.offset.data(), n);
}

/* The laws in words, not as the map that the solver drives to zero. */
void require_laws(const IslandProblem &problem, double speed)
{
  const Eigen::VectorXd w = speeds_of(problem);
  for (const ManifoldRows &m : problem.manifolds) {
    double sum = 0;
    for (uint32_t i = m.first; i < m.first + m.normals; ++i) {
      const double x = problem.impulse[i];
      CHECK(x >= 0);
      CHECK(w[i] > -speed);
      if (x > 0) CHECK(w[i] < speed);
      sum += x;
    }
    const uint32_t t = m.first + m.normals;
    const double first = problem.impulse[t], second = problem.impulse[t + 1], slide = std::hypot(w[t], w[t + 1]);
    const double limit = m.friction * sum, used = std::hypot(first, second);
    CHECK(used <= limit * (1 + 1e-12));
    if (slide > 1e-4) { /* slips: all of the cone, against the motion */
      CHECK(used == Approx(limit).margin(1e-6));
      CHECK(first * w[t] + second * w[t + 1] == Approx(-used * slide).margin(1e-6));
    }
    const double twist = problem.impulse[t + 2], twist_limit = limit * m.twist_radius;
    CHECK(std::abs(twist) <= twist_limit * (1 + 1e-12));
    if (std::abs(w[t + 2]) > 1e-4) CHECK(twist == Approx(w[t + 2] > 0 ? -twist_limit : twist_limit).margin(1e-6));
  }
}

} // namespace

TEST_CASE("island solver: without friction every random problem converges", "[direct]")
{
  Random random(1);
  for (int k = 0; k < 60; ++k) {
    IslandProblem problem = random_problem(random, 1 + k % 5, 6 + k % 7, 0.0);
    const IslandResult result = solve(problem);
    CAPTURE(k, result.residual, result.newton_steps, result.iterations);
    CHECK(result.converged);
    CHECK(result.yielded < 1e-3);
    require_laws(problem, result.yielded + 1e-8);
  }
}

TEST_CASE("island solver: with friction the laws hold wherever it converges, and it nearly always does", "[direct]")
{
  Random random(2);
  int converged = 0;
  for (int k = 0; k < 60; ++k) {
    IslandProblem problem = random_problem(random, 1 + k % 4, 12, 0.3);
    const IslandResult result = solve(problem);
    CAPTURE(k, result.residual, result.newton_steps, result.iterations);
    for (double x : problem.impulse) REQUIRE(std::isfinite(x));
    if (!result.converged) continue;
    ++converged;
    CHECK(result.yielded < 1e-3);
    require_laws(problem, result.yielded + 1e-8);
  }
  INFO(converged << " of 60 converged");
  CHECK(converged >= 54);
}

TEST_CASE("island solver: what has no solution gives back no worse than the guess, and always numbers", "[direct]")
{
  /* Friction so strong that it drives the bodies together (Painleve's paradox), and rows that nothing can satisfy. */
  Random random(3);
  for (int k = 0; k < 12; ++k) {
    IslandProblem problem = random_problem(random, 2, 6, 20.0);
    for (uint32_t i = 0; i < problem.rows; ++i)
      problem.offset[i] = random.uniform(-100, 100); /* outside the range of W */
    IslandProblem once = problem;
    const IslandResult result = solve(problem);
    for (double x : problem.impulse) CHECK(std::isfinite(x));
    const IslandResult again = solve(once);
    CHECK(once.impulse == problem.impulse);
    CHECK(again.residual == result.residual);
    double guess = 0; /* of no impulses: only normals that approach miss their law */
    for (const ManifoldRows &m : problem.manifolds)
      for (uint32_t i = m.first; i < m.first + m.normals; ++i) guess = std::max(guess, -problem.offset[i]);
    CHECK(result.residual <= guess);
  }
}

namespace {

/* Contacts that push one way and the other, or one on another, without friction. */
IslandProblem problem_of(const Eigen::Matrix2d &matrix, const Eigen::Vector2d &offset, double guess)
{
  IslandProblem problem;
  problem.rows = 2;
  problem.matrix.assign(matrix.data(), matrix.data() + 4);
  problem.offset.assign(offset.data(), offset.data() + 2);
  problem.impulse.assign(2, guess);
  for (uint32_t k = 0; k < 2; ++k) problem.manifolds.push_back({k, 1, false, false, 0, 0});
  return problem;
}

} // namespace

TEST_CASE("island solver: a body that two walls want out to both sides gets impulses of its size", "[direct]")
{
  /* The left wall wants 1 m/s to the right, the right one 0.4 to the left, and both give way by a hundredth of their
   * impulse. */
  Eigen::Matrix2d matrix;
  matrix << 1, -1, -1, 1;
  const Eigen::Vector2d offset(-1, -0.4);
  const Eigen::Vector2d expected = (matrix + 0.01 * Eigen::Matrix2d::Identity()).inverse() * -offset;
  for (const double guess : {0.0, 0.1, 50.0, 1e4}) {
    IslandProblem problem = problem_of(matrix, offset, guess);
    CAPTURE(guess);
    CHECK(solve(problem).converged);
    CHECK(problem.impulse[0] == Approx(expected[0]).epsilon(1e-9));
    CHECK(problem.impulse[1] == Approx(expected[1]).epsilon(1e-9));
  }
}

TEST_CASE("island solver: a load beside a jam is borne whole", "[direct]")
{
  /* The jam above, and a ton on a kilogram. */
  IslandProblem problem;
  problem.rows = 4;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  matrix.topLeftCorner<2, 2>() << 1, -1, -1, 1;
  matrix.bottomRightCorner<2, 2>() << 1, -1, -1, 1.001;
  problem.matrix.assign(matrix.data(), matrix.data() + 16);
  problem.offset = {-1, -0.4, -0.1, 0};
  for (uint32_t k = 0; k < 4; ++k) problem.manifolds.push_back({k, 1, false, false, 0, 0});
  for (const double guess : {0.0, 100.0}) {
    problem.impulse = {0, 0, guess, guess};
    CHECK(solve(problem).converged);
    CHECK(problem.impulse[0] + problem.impulse[1] < 200);
    /* Both rows may yield a ten-thousandth of the largest speed, and together they give 0.001 m/s for 1 N s. */
    CHECK(problem.impulse[2] == Approx(100.1).margin(0.201));
    CHECK(problem.impulse[3] == Approx(100).margin(0.201));
  }
}

TEST_CASE("island solver: a load a hundred thousand times as heavy as what bears it is borne", "[direct]")
{
  /* 1 g on the ground and 100 kg on it, both with 0.1 m/s downwards: the ground gives 10.0001 N s, the gram 10. */
  Eigen::Matrix2d matrix;
  matrix << 1e3, -1e3, -1e3, 1e3 + 1e-2;
  IslandProblem problem = problem_of(matrix, {-0.1, 0}, 0);
  CHECK(solve(problem).converged);
  CHECK(problem.impulse[0] == Approx(10.0001).epsilon(1e-3));
  CHECK(problem.impulse[1] == Approx(10).epsilon(1e-3));
}
