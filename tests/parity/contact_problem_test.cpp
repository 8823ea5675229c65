/* Contact problems give the same bits on every backend: each residual of the history and every impulse. */
#include "host/runtime/make_backend.h"
#include "host/verify/contact_solver.h"
#include "shared/problem/pass.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

/* A chain of links with neighbours three apart, so that levels hold several contacts and tiles of sums are crossed. */
ContactProblem chain(uint32_t n)
{
  ContactProblem problem;
  problem.contacts = n;
  uint32_t state = 7;
  const auto number = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0 - 0.5; };
  for (uint32_t i = 0; i < n; ++i) {
    problem.start.push_back(static_cast<uint32_t>(problem.column.size()));
    problem.column.push_back(i);
    problem.blocks.push_back({2.5, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 4});
    for (const uint32_t j : {i - 3, i + 3})
      if (j < n) {
        problem.column.push_back(j);
        problem.blocks.push_back({-1, 0.05, 0, 0.05, -1, 0, 0, 0, -1});
      }
    problem.free_velocity.push_back({number() - 0.3, number(), number()});
    problem.friction.push_back(i % 7 == 0 ? 0 : 0.3 + 0.1 * (i % 5));
  }
  problem.start.push_back(static_cast<uint32_t>(problem.column.size()));
  return problem;
}

ContactSolution solved(const ContactProblem &problem, const std::string &solver, const std::string &on)
{
  const auto backend = make_backend(on);
  return solve_contact_problem(problem, {parse_contact_solver(solver), 1e-9, 12}, *backend);
}

void require_equal(const ContactProblem &problem, const std::vector<std::string> &backends)
{
  for (const char *solver : {"pgs", "nncg", "jacobi"}) {
    const ContactSolution expected = solved(problem, solver, "serial");
    REQUIRE(expected.history.size() == 12);
    REQUIRE(expected.history.back() < 0.5 * expected.history.front());
    for (const std::string &backend : backends) {
      CAPTURE(solver, backend);
      const ContactSolution found = solved(problem, solver, backend);
      CHECK(found.history == expected.history);
      CHECK(found.impulse == expected.impulse);
      CHECK(found.residuals.fischer_burmeister == expected.residuals.fischer_burmeister);
      CHECK(found.residuals.cone_violation == expected.residuals.cone_violation);
    }
  }
}

} // namespace

/* The same arithmetic in one plain loop from the first contact to the last. */
TEST_CASE("parity on CPU: levels of a contact problem give the bits of the plain pass")
{
  const ContactProblem problem = chain(1000);
  std::vector<float4> blocks, free, step(1000), impulse(1000, float4{0, 0, 0, 0});
  std::vector<float> trace(1000), reference(1000);
  const auto number = [](double value) { return static_cast<float>(value); };
  for (const auto &b : problem.blocks)
    for (size_t k = 0; k < 9; k += 3) blocks.push_back({number(b[k]), number(b[k + 1]), number(b[k + 2]), 0});
  for (size_t i = 0; i < 1000; ++i) {
    const auto &q = problem.free_velocity[i];
    free.push_back({number(q[0]), number(q[1]), number(q[2]), number(problem.friction[i])});
  }
  const uint32_t *start = problem.start.data(), *column = problem.column.data();
  for (uint32_t i = 0; i < 1000; ++i)
    problem_prepare_item(start, column, blocks.data(), free.data(), step.data(), trace.data(), reference.data(), i);
  for (int iteration = 0; iteration < 12; ++iteration)
    for (uint32_t i = 0; i < 1000; ++i)
      solve_problem_contact(start, column, blocks.data(), free.data(), step.data(), impulse.data(), impulse.data(), 0,
                            i);
  const ContactSolution found = solved(problem, "pgs", "tbb");
  REQUIRE(contact_levels(problem).start.size() > 300);
  for (size_t i = 0; i < 1000; ++i) {
    CAPTURE(i);
    REQUIRE(found.impulse[i] == std::array<double, 3>{impulse[i].x, impulse[i].y, impulse[i].z});
  }
}

TEST_CASE("parity on CPU: contact problems") { require_equal(chain(5000), cpu_backends()); }

TEST_CASE("parity on CPU: threads share a contact problem", "[sanitizer]")
{
  require_equal(chain(5000), {"tbb:threads=4"});
}

TEST_CASE("parity on OpenCL: contact problems")
{
  require_pocl();
  require_equal(chain(5000), {"cl:pocl"});
}
