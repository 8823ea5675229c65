/* island_solver.h - one dense problem of contacts with friction and of joints, solved to convergence in double;
 * island.h makes the problems.
 *
 *   w = W x + offset          W: Delassus operator, x: impulses, w: speeds of the rows
 *
 *   normal   x >= 0, w >= 0, x w = 0
 *   tangent  |x_t| <= friction * (sum of the manifold's normals), opposed to w_t where it slips
 *   twist    |x| <= friction * twist_radius * (the same sum), opposed to w where it slips
 *   bounded  lower <= x <= upper; w = 0 in between, w >= 0 at the lower bound, w <= 0 at the upper one
 *
 * The method is semismooth Newton on the natural map (Alart and Curnier, 1991; survey: Acary, Bremond and Huber, "On
 * solving contact problems with Coulomb friction", 2018). Where it stalls, passes of nonsmooth Gauss-Seidel (Jean,
 * 1999) follow.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/base/arena.h"

namespace tandem {

/* The rows of one manifold: `normals` of them from `first`, then two tangents if `slides`, then a twist if `twists`. */
struct ManifoldRows {
  uint32_t first = 0, normals = 0;
  bool slides = false, twists = false;
  double friction = 0;     /* >= 0 */
  double twist_radius = 0; /* m */
};

/* A row of a joint. */
struct BoundedRow {
  uint32_t row = 0;
  double lower = 0, upper = 0; /* infinite if it has none */
};

struct IslandProblem {
  uint32_t rows = 0;
  std::vector<double> matrix; /* W, rows x rows, symmetric, diagonal > 0 */
  std::vector<double> offset; /* m/s, rad/s for twists */
  std::vector<ManifoldRows> manifolds;
  std::vector<BoundedRow> bounded;
  std::vector<double> impulse; /* N s: a guess on input, the solution on output */
};

struct IslandResult {
  bool converged = false;
  double residual = 0; /* m/s: the largest speed by which a row violates its law (natural map over its step) */
  double yielded = 0;  /* m/s: the largest speed that the compliance takes from what a row wants */
  uint32_t newton_steps = 0, iterations = 0;
};

/* Each row has a compliance of a millionth of its own response, applied to the difference of its impulse from the
 * guess; where that would show, the problem is solved again about its solution. Where rows contradict each other, as
 * those of a body between two walls that want it out to both sides, they have a compliance of a hundredth, applied to
 * their whole impulse. The result has converged if the residual is at most 1e-9 of the largest speed of the problem. If
 * neither method converges, the impulses are the best ones found, including the guess. They are finite if the problem
 * is.
 *
 * The solver allocates nothing. It works in the arena, in which island_solver_bytes(problem.rows) must be reserved. */
IslandResult solve_island(IslandProblem &problem, Arena &arena);
size_t island_solver_bytes(size_t rows);

} // namespace tandem
