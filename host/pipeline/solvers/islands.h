/* islands.h - the stage solve_islands: small islands of bodies that touch or are joined, each solved to convergence in
 * double.
 *
 *   constraints --> islands (bodies that move, joined by constraints) --> one dense problem each --> impulses
 *
 *        [a]--[b]      [d]        a, b, c: one island; d: another. Bodies that cannot move connect no islands.
 *         |  /          |
 *   ======[c]===========|=====
 *
 * It runs after a pass of the iterative solver (shared/solve/soft_step.h, shared/joints/solve.h) and solves the same
 * rows: normals, one friction cone at the centre of a manifold, one twist, and those of joints and couplings. Contacts
 * are rigid here, whereas soft rows yield under a heavy load; the speed that removes penetration is the same. Islands
 * of more than most_island_points keep the iterative result; four rows of a joint count as a point.
 */
#pragma once

#include <memory>

#include "host/pipeline/cpu_kernels.h"

namespace tandem {

constexpr uint32_t most_island_points = 96;

/* A kernel of execution HOST; the value of its launch is the pass (shared/solve/pass.h). Islands are solved in
 * parallel, each by one task, so the result does not depend on the number of threads. */
std::unique_ptr<CpuKernel> make_solve_islands();

} // namespace tandem
