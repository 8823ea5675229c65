/* pgs_tail.h - the rows of pgs.h for constraints without a colour of their own, in order; see shared/solve/tail.h. */
#ifndef TANDEM_SHARED_SOLVE_PGS_TAIL_H
#define TANDEM_SHARED_SOLVE_PGS_TAIL_H

#include "shared/solve/pgs.h"
#include "shared/solve/tail.h"

SHARED void pgs_normals_tail_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                  GLOBAL const row *constraint_normal, GLOBAL const row *constraint_points,
                                  GLOBAL const memory_real *constraint_slop, GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                  GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_bounce,
                                  GLOBAL row *solver_velocity, uint biased, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  pgs_normals_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_slop, solver_inertia,
                   solver_delta, counts, constraint_normal_impulse, constraint_bounce, solver_velocity, biased, i);
}

SHARED void pgs_friction_tail_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                   GLOBAL const row *constraint_center, GLOBAL const row *constraint_normal_impulse,
                                   GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                   GLOBAL row *constraint_friction_impulse, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  pgs_friction_item(constraint_a, constraint_b, constraint_normal, constraint_center, constraint_normal_impulse, solver_inertia, solver_delta,
                    counts, constraint_friction_impulse, solver_velocity, i);
}

#endif
