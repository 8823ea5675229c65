/* contact_solver.cpp - launches the solvers of frictional contact problems; see contact_solver.h. */
#include "host/verify/contact_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <tandem/round_to_float.h>
#include <tandem/scene.h>

#include "host/pipeline/primitives.h"
#include "host/pipeline/setting_rows.h"
#include "host/runtime/launcher.h"
#include "shared/problem/residual.h"

namespace tandem {
namespace {

/* Kernels square their inputs in floats. A problem in units far from 1 is therefore converted by powers of two, which
 * round nothing: W' = W / compliance, q' = q / speed, r = r' speed / compliance. */
struct Units {
  double compliance = 1, speed = 1;
};

constexpr int most_exponent = 40; /* of two: with larger exponents squares could exceed the range of floats */

double power_near(double size)
{
  int exponent = 0;
  std::frexp(size, &exponent);
  return size > 0 && std::abs(exponent) > most_exponent ? std::ldexp(1.0, exponent) : 1.0;
}

double mean_of_diagonal(const ContactProblem &problem)
{
  double sum = 0;
  for (size_t i = 0; i < problem.contacts; ++i)
    for (const size_t k : {0, 4, 8}) sum += std::abs(problem.blocks[problem.start[i]][k]) / (3.0 * problem.contacts);
  return sum;
}

Units units_of(const ContactProblem &problem, double mean)
{
  double fastest = 0;
  for (const std::array<double, 3> &velocity : problem.free_velocity)
    for (const double component : velocity) fastest = std::max(fastest, std::abs(component));
  return {power_near(mean), power_near(fastest)};
}

ContactProblem in_units(ContactProblem problem, const Units &units)
{
  for (std::array<double, 9> &block : problem.blocks)
    for (double &value : block) value /= units.compliance;
  for (std::array<double, 3> &velocity : problem.free_velocity)
    for (double &component : velocity) component /= units.speed;
  return problem;
}

/* A problem is refused if the compliances of its contacts differ by more than the range of squared floats, whatever the
 * units. */
void check_range(const ContactProblem &problem, double mean)
{
  constexpr double widest = 1e18;
  for (size_t i = 0; i < problem.contacts; ++i)
    for (const size_t k : {0, 4, 8})
      if (const double own = std::abs(problem.blocks[problem.start[i]][k]); own > 0 && own * widest < mean)
        throw InputError(
            fmt::format("W of contact {} has {} on its diagonal, whose mean is {}: more than a factor of {} "
                        "between them is out of the range of 32-bit numbers; use --solver nsgs",
                        i, own, mean, widest));
}

class ProblemSolver {
public:
  ProblemSolver(const ContactProblem &problem, Backend &backend)
      : contacts_(problem.contacts), levels_(contact_levels(problem)), backend_(backend), launcher_(memory_, backend)
  {
    std::vector<Kernel> kernels = {Kernel::reduce_real_tiles, Kernel::reduce_real_partials};
    for (size_t k = 0; k < kernel_count; ++k)
      if (row_of(kernel_at(k)).stage == Stage::problem) kernels.push_back(kernel_at(k));
    backend_.prepare(0, kernels);
    upload_problem(problem);
    run({Kernel::problem_prepare, {Buffer::problem_term_a, Buffer::problem_term_b}, {}});
    add_up(Reduction::sum, Buffer::problem_term_a, Buffer::problem_trace);
    add_up(Reduction::sum, Buffer::problem_term_b, Buffer::problem_sum);
    const double trace = memory_.read_reals(Buffer::problem_trace, 1)[0];
    const double size =
        double{RHO_FACTOR} * 3 * contacts_ / trace * std::sqrt(memory_.read_reals(Buffer::problem_sum, 1)[0]);
    scale_ = size > 0 ? 1 / size : 1; /* without any free velocity the solution is 0 and is found at once */
  }
  ~ProblemSolver() { backend_.finish(); }

  void iterate(ContactSolver solver)
  {
    if (solver == ContactSolver::jacobi) return jacobi_pass();
    for (uint32_t level = 0; level + 1 < levels_.start.size(); ++level)
      launcher_.launch({Kernel::problem_pass,
                        {},
                        {},
                        COUNT_TOTAL + level,
                        COUNT_TOTAL + level + 1,
                        levels_.start[level + 1] - levels_.start[level]});
    if (solver == ContactSolver::nncg) conjugate();
  }

  double natural_residual()
  {
    run({Kernel::problem_residual,
         {impulse_, Buffer::problem_term_a, Buffer::problem_term_b, Buffer::problem_term_c},
         {}});
    return relative(Buffer::problem_term_a);
  }

  /* Must be called after natural_residual(). */
  ContactResiduals residuals()
  {
    add_up(Reduction::largest, Buffer::problem_term_c, Buffer::problem_sum);
    const double violation = memory_.read_reals(Buffer::problem_sum, 1)[0];
    return {relative(Buffer::problem_term_a), relative(Buffer::problem_term_b), std::max(violation, 0.0)};
  }

  std::vector<std::array<double, 3>> impulses()
  {
    const std::vector<double> reals = memory_.read_reals(impulse_, size_t{contacts_} * 4);
    std::vector<std::array<double, 3>> impulses(contacts_);
    for (size_t i = 0; i < contacts_; ++i) impulses[i] = {reals[4 * i], reals[4 * i + 1], reals[4 * i + 2]};
    return impulses;
  }

private:
  template <class T> void upload(Buffer buffer, const std::vector<T> &values)
  {
    memory_.resize(buffer, values.size() * sizeof(T));
    memory_.upload(buffer, values.data(), values.size() * sizeof(T));
  }

  void upload_problem(const ContactProblem &problem)
  {
    std::vector<float> blocks, free;
    for (const std::array<double, 9> &block : problem.blocks)
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t k = 0; k < 4; ++k) blocks.push_back(k < 3 ? round_to_float(block[3 * axis + k]) : 0.0f);
    for (size_t i = 0; i < contacts_; ++i) {
      for (const double velocity : problem.free_velocity[i]) free.push_back(round_to_float(velocity));
      free.push_back(round_to_float(problem.friction[i]));
    }
    std::vector<uint32_t> counts(COUNT_TOTAL);
    counts[COUNT_ONE] = 1;
    counts[COUNT_LENGTH] = contacts_;
    counts.insert(counts.end(), levels_.start.begin(), levels_.start.end());
    upload(Buffer::counts, counts);
    upload(Buffer::problem_start, problem.start);
    upload(Buffer::problem_column, problem.column);
    upload(Buffer::problem_order, levels_.order);
    upload(Buffer::problem_block, blocks);
    upload(Buffer::problem_free, free);
    for (const Buffer rows :
         {Buffer::problem_step, Buffer::problem_impulse, Buffer::problem_previous, Buffer::problem_direction})
      memory_.resize(rows, size_of(Element::float4) * contacts_);
    for (const Buffer terms : {Buffer::problem_term_a, Buffer::problem_term_b, Buffer::problem_term_c})
      memory_.resize(terms, size_of(Element::real) * contacts_);
    for (const Buffer sum :
         {Buffer::problem_trace, Buffer::problem_change, Buffer::problem_change_other, Buffer::problem_sum})
      memory_.resize(sum, size_of(Element::real));
    memory_.resize(Buffer::problem_partial, size_of(Element::real) * reduce_partial_words(contacts_));
  }

  void run(Launch launch)
  {
    launch.last = COUNT_LENGTH;
    launch.expected = contacts_;
    launcher_.launch(launch);
  }

  void add_up(Reduction reduction, Buffer terms, Buffer sum)
  {
    reduce_real(launcher_, reduction, terms, Buffer::problem_partial, sum, COUNT_LENGTH, contacts_);
  }

  double relative(Buffer terms)
  {
    add_up(Reduction::sum, terms, Buffer::problem_sum);
    return scale_ * std::sqrt(memory_.read_reals(Buffer::problem_sum, 1)[0]);
  }

  void jacobi_pass()
  {
    const Buffer to = impulse_ == Buffer::problem_impulse ? Buffer::problem_previous : Buffer::problem_impulse;
    run({Kernel::problem_jacobi, {impulse_, to}, {}});
    impulse_ = to;
  }

  void conjugate()
  {
    run({Kernel::problem_change, {Buffer::problem_term_a}, {}});
    add_up(Reduction::sum, Buffer::problem_term_a, change_);
    run({Kernel::problem_conjugate, {change_, change_before_}, {conjugate_passes_++ == 0 ? 1u : 0u}});
    std::swap(change_, change_before_);
  }

  uint32_t contacts_;
  ContactLevels levels_;
  Backend &backend_;
  Memory memory_;
  DirectLauncher launcher_;
  Buffer impulse_ = Buffer::problem_impulse;
  Buffer change_ = Buffer::problem_change, change_before_ = Buffer::problem_change_other;
  uint32_t conjugate_passes_ = 0;
  double scale_ = 1;
};

} // namespace

std::span<const ContactSolverRow> contact_solvers()
{
  static constexpr ContactSolverRow rows[] = {{ContactSolver::pgs, "pgs"},
                                              {ContactSolver::nncg, "nncg"},
                                              {ContactSolver::jacobi, "jacobi"},
                                              {ContactSolver::nsgs, "nsgs"}};
  static_assert(are_in_order(rows));
  return rows;
}

ContactSolver parse_contact_solver(const std::string &name)
{
  std::string names;
  for (const auto &[choice, known] : contact_solvers()) {
    if (name == known) return choice;
    names += (names.empty() ? "" : ", ") + std::string(known);
  }
  throw InputError(fmt::format("--solver '{}' is unknown; use {}", name, names));
}

/* In theory W couples contacts in both directions; a file may contain only one of the two blocks, so both directions
 * count. */
ContactLevels contact_levels(const ContactProblem &problem)
{
  const uint32_t n = problem.contacts;
  std::vector<uint32_t> level(n, 0);
  std::vector<std::vector<uint32_t>> earlier(n);
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t k = problem.start[i]; k < problem.start[i + 1]; ++k)
      if (const uint32_t j = problem.column[k]; j != i) earlier[std::max(i, j)].push_back(std::min(i, j));
  uint32_t levels = 1;
  for (uint32_t i = 0; i < n; ++i) {
    for (const uint32_t j : earlier[i]) level[i] = std::max(level[i], level[j] + 1);
    levels = std::max(levels, level[i] + 1);
  }
  ContactLevels result;
  result.order.resize(n);
  std::iota(result.order.begin(), result.order.end(), 0u);
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](uint32_t a, uint32_t b) { return level[a] < level[b]; });
  result.start.assign(levels + 1, 0);
  for (const uint32_t l : level) ++result.start[l + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  return result;
}

ContactSolution solve_contact_problem(const ContactProblem &problem, const ContactSolverSettings &settings,
                                      Backend &backend)
{
  const double mean = mean_of_diagonal(problem);
  if (settings.solver != ContactSolver::nsgs) check_range(problem, mean);
  const Units units = units_of(problem, mean);
  ProblemSolver solver(in_units(problem, units), backend);
  ContactSolution solution;
  backend.finish();
  const auto begin = std::chrono::steady_clock::now();
  double residual = solver.natural_residual();
  while (!(residual <= settings.tolerance) && solution.iterations < settings.iterations && std::isfinite(residual)) {
    solver.iterate(settings.solver);
    solution.history.push_back(residual = solver.natural_residual());
    ++solution.iterations;
  }
  backend.finish();
  solution.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  solution.converged = residual <= settings.tolerance;
  solution.residuals = solver.residuals();
  solution.impulse = solver.impulses();
  for (std::array<double, 3> &impulse : solution.impulse)
    for (double &component : impulse) component *= units.speed / units.compliance;
  return solution;
}

} // namespace tandem
