/* islands.h - the stage solve_islands: small islands of touching bodies, each solved to convergence in double.
 *
 *   constraints --> islands (bodies that move, joined by constraints) --> one dense contact problem each --> impulses
 *
 *        [a]--[b]      [d]        a, b, c: one island; d: another. What cannot move joins nothing.
 *         |  /          |
 *   ======[c]===========|=====
 *
 * It runs after a pass of the iterative rows (shared/solve/contact.h) and solves the same rows: normals, one cone at
 * the centre of a manifold, one twist. Contacts are rigid here: the soft rows give way under a heavy load, these do
 * not; the speed that pushes penetration out is theirs. Islands of more than most_island_points keep what the rows
 * left.
 */
#pragma once

#include "host/runtime/interface/backend.h"

namespace tandem {

constexpr uint32_t most_island_points = 96;

/* A kernel of execution HOST; the value of its launch is the pass (shared/solve/pass.h). Islands run in parallel; each
 * is solved by one task, so the result does not depend on threads. */
void solve_islands(const Launch &launch, Memory &memory);

} // namespace tandem
