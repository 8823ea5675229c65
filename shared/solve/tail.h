/* tail.h - the constraints past the last colour, in order by one item: for solvers whose rows are not those of mass_split.h.
 *
 * Right and the same everywhere, but as slow as the tail is long; a body of ten thousand contacts wants mass_split.h.
 */
#ifndef TANDEM_SHARED_SOLVE_TAIL_H
#define TANDEM_SHARED_SOLVE_TAIL_H

#include "shared/solve/contact.h"

#define FOR_EACH_IN_TAIL(i) for (uint i = counts[COLOR_START + COLOR_TAIL]; i < counts[COUNT_CONSTRAINTS]; ++i)

SHARED void warm_start_tail_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                 GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                                 GLOBAL const row *constraint_normal_impulse, GLOBAL const row *constraint_friction_impulse,
                                 GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                 GLOBAL const uint *counts, GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  warm_start_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center, constraint_normal_impulse,
                  constraint_friction_impulse, solver_inertia, solver_delta, counts, solver_velocity, i);
}

SHARED void solve_tail_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                            GLOBAL const row *constraint_normal, GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                            GLOBAL const memory_real *constraint_slop, GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                            GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_friction_impulse, GLOBAL row *constraint_bounce,
                            GLOBAL row *solver_velocity, GLOBAL row *solver_push, uint pass, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  solve_contacts_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center, constraint_slop,
                      solver_inertia, solver_delta, counts, constraint_normal_impulse, constraint_friction_impulse,
                      constraint_bounce, solver_velocity, solver_push, pass, i);
}

SHARED void apply_restitution_tail_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b, GLOBAL const row *constraint_normal,
                                        GLOBAL const row *constraint_points, GLOBAL const row *constraint_bounce,
                                        GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                        GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse,
                                        GLOBAL row *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_IN_TAIL(i)
  apply_restitution_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_bounce, solver_inertia,
                         solver_delta, counts, constraint_normal_impulse, solver_velocity, i);
}

#endif
