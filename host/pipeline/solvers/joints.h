/* joints.h - launches of joints and couplings that solvers share; see shared/joints/solve.h.
 *
 * Their rows are those of shared/joints/axes.h and solve.h in all solvers but avbd: a pass with bias closes what is
 * open, and one without takes the velocity of closing out again. Solvers differ in when they make these passes, and in
 * what they do with the impulses of the last step:
 *
 *   soft-step, pgs, nncg   a pass over joints in each pass over contacts, the joints of a colour before its contacts
 *   jacobi                 all joints and contacts at once (mass_split.h), couplings by their colours after them
 *   direct                 the passes of soft-step, and after them joints and contacts of small islands together
 *   xpbd                   from no impulses in each substep; what is open is closed whole, and then velocities
 *   avbd                   none of them: its bodies are moved against the rows of shared/joints/avbd_rows.h
 */
#pragma once

#include "host/pipeline/step_launches.h"

namespace tandem {

/* Before the first substep. */
void begin_joints(StepLaunches &step);
/* The impulses of the last step: of joints, contacts and couplings, colour by colour, or of couplings alone. */
void warm_start_with_joints(StepLaunches &step);
void warm_start_couplings(StepLaunches &step);
/* Zeroes the impulses, for a solver that begins each substep without. */
void clear_joint_impulses(StepLaunches &step);
/* A pass over joints, couplings, and the constraints that have a colour. pass: of shared/solve/pass.h; value: of the
 * kernel of constraints; further: of a batch of worlds, only those with overflow constraints take part. */
void solve_with_joints(StepLaunches &step, Kernel constraints, uint32_t pass, uint32_t value, bool further = false);
/* The same without constraints, and of couplings alone. */
void solve_joints(StepLaunches &step, uint32_t pass);
void solve_couplings(StepLaunches &step, uint32_t pass);
/* After the last pass of a substep. */
void follow_joints(StepLaunches &step, uint32_t substep);
/* After the last substep: what arrived at limits leaves them again. */
void bounce_joints(StepLaunches &step);

} // namespace tandem
