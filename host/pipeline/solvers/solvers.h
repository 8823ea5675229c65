/* solvers.h - the list of solvers: for each its choice, name, description, default substeps and iterations, and the
 * function that launches it.
 *
 * A solver runs between prepare_contacts, which makes the constraints, and check_bodies. It leaves solver_velocity,
 * solver_delta_pose and solver_orientation at the end of the step, and the impulses in constraint_normal_impulse and
 * constraint_friction_impulse, for the next step's warm start. Each is one small file here over row kernels of
 * shared/solve/. */
#pragma once

#include <span>

#include "host/pipeline/step_launches.h"

namespace tandem {

struct SolverRow {
  Solver choice;
  const char *name, *what;
  uint32_t substeps, iterations; /* defaults */
  bool couplings;                /* whether it solves them */
  void (*launch)(StepLaunches &step);
  void (*commit)(StepLaunches &step) =
      nullptr; /* stores what the solver keeps for the next step, once the step has succeeded */
};

std::span<const SolverRow> solvers(); /* in the order of the enum */
const SolverRow &row_of(Solver solver);

void launch_soft_step(StepLaunches &step);
/* Of islands of many substeps: between those of one of theirs and of one of the few (shared/substep_classes.h). */
void share_impulses_of_contacts(StepLaunches &step, bool back);
void launch_pgs(StepLaunches &step);
void launch_nncg(StepLaunches &step);
void launch_xpbd(StepLaunches &step);
void commit_xpbd(StepLaunches &step);
void launch_avbd(StepLaunches &step);
void commit_avbd(StepLaunches &step);
void launch_jacobi(StepLaunches &step);
void launch_direct(StepLaunches &step);

/* So many colours of bodies avbd launches as long as the host knows no number of them. */
constexpr uint32_t first_body_colors = 32;

class MassSplit;

/* Launches that several solvers share: the impulses of the last step or substep, applied once more; one pass of pgs,
 * with friction after all normals (pass: of shared/solve/pass.h); restitution; and the torques of rolling friction,
 * which launch nothing in a scene without it. */
void warm_start_contacts(StepLaunches &step, MassSplit &overflow);
void launch_pgs_pass(StepLaunches &step, MassSplit &overflow, uint32_t pass);
void apply_restitution(StepLaunches &step, MassSplit &overflow);
/* Of contacts and joints, for solvers that split the mass of overflow constraints for nothing else. */
void bounce_at_end(StepLaunches &step);
void warm_start_rolling(StepLaunches &step);
void solve_rolling(StepLaunches &step);

} // namespace tandem
