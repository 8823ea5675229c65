/* solvers.cpp - the table of the solvers; see solvers.h. */
#include "host/pipeline/solvers/solvers.h"

#include "host/pipeline/setting_rows.h"

namespace tandem {

std::span<const SolverRow> solvers()
{
  static constexpr SolverRow rows[] = {
      {Solver::soft_step, "soft-step", "small substeps, soft contacts, a relaxing pass (Catto 2024)", 4, 1, true,
       launch_soft_step},
      {Solver::pgs, "pgs",
       "projected Gauss-Seidel on velocities, normals of all batches, then friction (Coumans 2009, 2013)", 1, 10, true,
       launch_pgs},
      {Solver::nncg, "nncg", "nonsmooth nonlinear conjugate gradients over pgs (Silcowitz, Niebe and Erleben 2010)", 1,
       10, true, launch_nncg},
      {Solver::xpbd, "xpbd", "small substeps that correct positions, then velocities (Mueller and others 2020)", 8, 1,
       true, launch_xpbd, commit_xpbd},
      {Solver::avbd, "avbd", "bodies one by one against penalties with multipliers (Giles, Diaz and Yuksel 2025)", 1,
       10, false, launch_avbd, commit_avbd},
      {Solver::jacobi, "jacobi", "all contacts and joints at once on bodies split by mass (Tonge and others 2012)", 4,
       8, true, launch_jacobi},
      {Solver::direct, "direct", "soft-step, then small islands solved to convergence in double on the CPU", 4, 1, true,
       launch_direct},
  };
  static_assert(are_in_order(rows));
  return rows;
}

const SolverRow &row_of(Solver solver) { return row_in(solvers(), solver); }

Settings settings_for(Solver solver)
{
  name_of(solver); /* InputError if there is no solver of this number */
  Settings settings;
  settings.solver = solver;
  settings.substeps = row_of(solver).substeps;
  settings.iterations = row_of(solver).iterations;
  return settings;
}

bool solves_couplings(Solver solver)
{
  name_of(solver); /* InputError if there is no solver of this number */
  return row_of(solver).couplings;
}

} // namespace tandem
