/* contact_solver.h - solves a frictional contact problem by itself, on any backend, and records its residual.
 *
 * It launches the kernels of shared/problem/ in order. docs/contact-problems.md describes the measurements, and
 * shared/problem/pass.h the methods.
 */
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/io/contact_problem/file.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"

namespace tandem {

/* nsgs is pgs in double precision and runs on the backend `reference`. */
enum class ContactSolver : uint8_t { pgs, nncg, jacobi, nsgs };

struct ContactSolverRow {
  ContactSolver choice;
  const char *name;
};
std::span<const ContactSolverRow> contact_solvers(); /* in the order of the enum */
/* The solver of this name. InputError lists those that there are. */
ContactSolver parse_contact_solver(const std::string &name);

struct ContactSolverSettings {
  ContactSolver solver = ContactSolver::pgs;
  double tolerance = 1e-3;    /* relative natural-map residual at which the solver stops, >= 0 */
  uint32_t iterations = 1000; /* passes at most */
};

struct ContactResiduals {
  double natural_map = 0, fischer_burmeister = 0; /* relative */
  double cone_violation = 0;                      /* the largest of all contacts, N s */
};

struct ContactSolution {
  bool converged = false;
  uint32_t iterations = 0;
  std::vector<double> history; /* relative natural-map residual after each pass */
  ContactResiduals residuals;  /* after the last */
  std::vector<std::array<double, 3>> impulse;
  double milliseconds = 0; /* passes and residuals, without building kernels and the first transfers */
};

ContactSolution solve_contact_problem(const ContactProblem &problem, const ContactSolverSettings &settings,
                                      Backend &backend);

/* An order of contacts in levels for which a parallel pass equals the sequential pass over all contacts: the order, and
 * the start of each level. */
struct ContactLevels {
  std::vector<uint32_t> order, start;
};
ContactLevels contact_levels(const ContactProblem &problem);

} // namespace tandem
