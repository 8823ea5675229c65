/* contact_solver_test.cpp - frictional contact problems: closed forms, an oracle in Eigen, the published figures. */
#include <cmath>
#include <filesystem>

#include "host/runtime/make_backend.h"
#include "host/verify/contact_solver.h"
#include "shared/problem/residual.h"
#include "tests/catch.h"
#include "tests/host/io/contact_problem/problems.h"
#include "tests/shared_data.h"

using namespace tandem;
namespace fs = std::filesystem;

namespace {

const std::string scenes = TANDEM_SOURCE_DIR "/tests/scenes/";
const char *const small_problems[] = {"contact-sticking.dat", "contact-sliding.dat", "box-on-corners.dat",
                                      "ball-in-groove.dat", "column-and-strays.dat"};

ContactSolution solved(const ContactProblem &problem, const std::string &solver, const std::string &on,
                       double tolerance)
{
  const auto backend = make_backend(on);
  return solve_contact_problem(problem, {parse_contact_solver(solver), tolerance, 100'000}, *backend);
}

void check_impulse(const std::array<double, 3> &impulse, const std::array<double, 3> &expected)
{
  for (size_t axis = 0; axis < 3; ++axis) CHECK(impulse[axis] == Approx(expected[axis]).margin(1e-6));
}

} // namespace

TEST_CASE("contact problem: every solver finds the impulses of closed forms")
{
  for (const auto &[choice, name] : contact_solvers()) {
    const std::string solver = name;
    CAPTURE(solver);
    const auto impulse = [&](const char *file) {
      return solved(read_contact_problem(scenes + file), solver, "reference", 1e-8).impulse;
    };
    check_impulse(impulse("contact-sticking.dat")[0], {0.5, -0.15, 0.1});
    check_impulse(impulse("contact-sliding.dat")[0], {0.5, -0.15, 0.2});
    const auto column = impulse("column-and-strays.dat");
    CHECK(column[0][0] == Approx(1)); /* carries both */
    CHECK(column[1][0] == Approx(0.5));
    check_impulse(column[2], {0, 0, 0});    /* opens */
    check_impulse(column[3], {0.25, 0, 0}); /* slides without friction */
    double weight = 0, push = 0, side = 0;
    for (const auto &corner : impulse("box-on-corners.dat")) weight += corner[0], side += corner[1], push += corner[2];
    CHECK(weight == Approx(4 * 0.1640625)); /* kg m/s: gravity of 1/60 s */
    CHECK(push == Approx(-4 * 0.0625));
    CHECK(side == Approx(0).margin(1e-6));
    const auto groove =
        impulse("ball-in-groove.dat"); /* rolls: I / (I + m d^2) of its speed is left, d the lever of both points */
    CHECK(groove[0][1] + groove[1][1] == Approx(-0.1 / (1 + 0.125 / 0.1)));
  }
}

TEST_CASE("contact problem: solutions and residuals agree with the dense oracle")
{
  for (const char *file : small_problems) {
    const ContactProblem problem = read_contact_problem(scenes + file);
    const DenseProblem dense(problem);
    const Eigen::VectorXd expected = dense.velocity(dense.fixed_point());
    for (const auto &[choice, name] : contact_solvers()) {
      const std::string solver = name;
      CAPTURE(file, solver);
      const auto backend = make_backend("reference");
      const ContactSolution early = solve_contact_problem(problem, {choice, 1e-12, 2}, *backend);
      CHECK(early.residuals.natural_map ==
            Approx(dense.natural_residual(vector_of(early.impulse))).epsilon(1e-5).margin(1e-7));
      const ContactSolution last = solved(problem, solver, "reference", 1e-7);
      REQUIRE(last.converged);
      CHECK(last.residuals.natural_map == last.history.back());
      CHECK(last.history.size() == last.iterations);
      CHECK((dense.velocity(vector_of(last.impulse)) - expected).norm() < 1e-5 * dense.free_velocity.norm());
      CHECK(last.residuals.fischer_burmeister < 1e-6);
      CHECK(last.residuals.cone_violation < 1e-9);
    }
  }
}

TEST_CASE("contact problem: float solvers come as near as rounding lets them")
{
  for (const char *file : small_problems)
    for (const char *solver : {"pgs", "nncg", "jacobi"}) {
      CAPTURE(file, solver);
      CHECK(solved(read_contact_problem(scenes + file), solver, "serial", 2e-5).converged);
    }
}

TEST_CASE(
    "contact problem: the Fischer-Burmeister function of the cone is zero at complementary pairs and nowhere else")
{
  const auto jordan_square = [](vec3 a) { return make_vec3(dot3(a, a), 2 * a.x * a.y, 2 * a.x * a.z); };
  uint32_t state = 1;
  const auto number = [&] {
    return static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) / 8388608.0f - 1.0f;
  };
  for (int k = 0; k < 1000; ++k) {
    const vec3 x = make_vec3(number(), number(), number()), y = make_vec3(number(), number(), number());
    const vec3 root = subtract(add(x, y), fischer_burmeister(x, y));
    const vec3 square = jordan_square(root), wanted = add(jordan_square(x), jordan_square(y));
    REQUIRE(length_of(subtract(square, wanted)) < 1e-4f);
    REQUIRE(root.x > tangent_length(root) - 1e-4f);
    /* on opposite sides of the cone: x.y = 0 and both in it */
    const float a = number() * 3.0f, size = magnitude(number()), other = magnitude(number());
    const float c = std::cos(a), s = std::sin(a);
    const vec3 pair = fischer_burmeister(scale(make_vec3(1, c, s), size), scale(make_vec3(1, -c, -s), other));
    REQUIRE(length_of(pair) < 2e-3f); /* the root of a number near 0 */
    REQUIRE(length_of(fischer_burmeister(scale(make_vec3(1, c, s), size + 0.1f), make_vec3(1, c, s))) > 0.05f);
  }
}

/* In units in which the squares of W or of q leave the range of floats. */
TEST_CASE("contact problem: units change the impulses by their ratio alone")
{
  const ContactProblem problem = read_contact_problem(scenes + "box-on-corners.dat");
  const ContactProblem sliding = read_contact_problem(scenes + "contact-sliding.dat");
  for (const std::string solver : {"pgs", "nncg", "jacobi"})
    for (const ContactProblem &given : {problem, sliding}) {
      const ContactSolution plain = solved(given, solver, "serial", 1e-5);
      for (const auto &[compliance, speed] :
           {std::pair(80, 0), std::pair(-80, 0), std::pair(0, -77), std::pair(90, 60), std::pair(-60, -100)}) {
        ContactProblem far = given;
        for (auto &block : far.blocks)
          for (double &value : block) value = std::ldexp(value, compliance);
        for (auto &velocity : far.free_velocity)
          for (double &component : velocity) component = std::ldexp(component, speed);
        const ContactSolution found = solved(far, solver, "serial", 1e-5);
        CAPTURE(solver, compliance, speed);
        CHECK(plain.converged);
        CHECK(found.converged);
        for (size_t i = 0; i < given.contacts; ++i)
          for (size_t axis = 0; axis < 3; ++axis)
            CHECK(std::ldexp(found.impulse[i][axis], compliance - speed) ==
                  Approx(plain.impulse[i][axis]).epsilon(1e-3).margin(1e-5));
      }
    }
}

TEST_CASE("contact problem: what floats cannot square side by side is refused")
{
  ContactProblem problem = read_contact_problem(scenes + "contact-sticking.dat");
  problem.blocks[0] = {1e-30, 0, 0, 0, 1e30, 0, 0, 0, 1e-30};
  CHECK_THROWS_WITH(solved(problem, "pgs", "serial", 1e-5),
                    Catch::Matchers::ContainsSubstring("out of the range of 32-bit numbers; use --solver nsgs"));
}

TEST_CASE("contact problem: levels keep the order of the plain pass")
{
  const ContactProblem problem = read_contact_problem(scenes + "column-and-strays.dat");
  const ContactLevels levels = contact_levels(problem);
  CHECK(levels.order == std::vector<uint32_t>{0, 2, 3, 1});
  CHECK(levels.start == std::vector<uint32_t>{0, 3, 4});
  CHECK(contact_levels(read_contact_problem(scenes + "box-on-corners.dat")).start ==
        std::vector<uint32_t>{0, 1, 2, 3, 4});
}

TEST_CASE("contact problem: Siconos's problems take the published numbers of sweeps")
{
  const fs::path folder = shared_data("siconos");
  struct Figure {
    const char *file;
    double pgs, nncg;
  };
  for (const Figure &figure : {Figure{"KaplasTower-i1061-4.hdf5.dat", 120, 48},
                               {"BoxesStack1-i100000-32.hdf5.dat", 220, 70},
                               {"OneObject-i100000-316.hdf5.dat", 60, 18},
                               {"Capsules-i100-889.dat", 2, 3}}) {
    CAPTURE(figure.file);
    const ContactProblem problem = read_contact_problem((folder / figure.file).string());
    CHECK(solved(problem, "nsgs", "reference", 1e-3).iterations == Approx(figure.pgs).epsilon(0.1));
    CHECK(solved(problem, "nncg", "reference", 1e-3).iterations == Approx(figure.nncg).epsilon(0.1));
  }
  for (const char *file : {"Rover1039.dat", "Rover4613.dat"}) {
    const ContactProblem problem = read_contact_problem((folder / file).string());
    for (const auto &[choice, name] : contact_solvers())
      CHECK(solved(problem, name, "reference", 1e-3).converged);
  }
}
