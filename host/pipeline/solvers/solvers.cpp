/* solvers.cpp - see solvers.h. */
#include "host/pipeline/solvers/solvers.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/scene.h>

namespace tandem {

const std::vector<Solver> &solvers()
{
  static const std::vector<Solver> list = {
      {"soft-step", "small substeps, soft contacts, a relaxing pass (Catto 2024)", 4, 1, launch_soft_step},
      {"pgs", "projected Gauss-Seidel on velocities, normals of all batches, then friction (Coumans 2009, 2013)", 1, 10,
       launch_pgs},
      {"nncg", "nonsmooth nonlinear conjugate gradients over pgs (Silcowitz, Niebe and Erleben 2010)", 1, 10,
       launch_nncg},
      {"xpbd", "small substeps that correct positions, then velocities (Mueller and others 2020)", 8, 1, launch_xpbd,
       commit_xpbd},
      {"avbd", "bodies one by one against penalties with multipliers (Giles, Diaz and Yuksel 2025)", 1, 10, launch_avbd,
       commit_avbd},
      {"jacobi", "all contacts at once on bodies split by mass (Tonge and others 2012)", 4, 8, launch_jacobi},
      {"direct", "soft-step, then small islands solved to convergence in double on the CPU", 4, 1, launch_direct},
  };
  return list;
}

const Solver &solver_named(const std::string &name)
{
  const auto found =
      std::find_if(solvers().begin(), solvers().end(), [&](const Solver &solver) { return solver.name == name; });
  if (found == solvers().end())
    throw InputError(fmt::format("solver '{}' is unknown; use {}", name, fmt::join(solver_names(), ", ")));
  return *found;
}

std::vector<std::string> solver_names()
{
  std::vector<std::string> names;
  for (const Solver &solver : solvers()) names.emplace_back(solver.name);
  return names;
}

Settings settings_for(const std::string &solver)
{
  Settings settings;
  settings.solver = solver;
  settings.substeps = solver_named(solver).substeps;
  settings.iterations = solver_named(solver).iterations;
  return settings;
}

} // namespace tandem
