/* nncg.h - nonsmooth nonlinear conjugate gradients over the sweeps of pgs.h.
 *
 * Silcowitz, Niebe and Erleben, "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force
 * Problems", The Visual Computer 26, 2010. A sweep of projected Gauss-Seidel maps all impulses x to PGS(x), and
 * x - PGS(x) takes the place of the gradient in the method of Fletcher and Reeves:
 *
 *     change = PGS(x) - x                             what the sweep did
 *     beta   = |change|^2 / |change before|^2         0 at first, and where it would be above 1: a restart
 *     x      = PGS(x) + beta direction                impulses, and by warm start's arithmetic the velocities
 *     direction = beta direction + change
 *
 * The last thing done is a sweep, so what is handed on lies in the cones.
 *
 * The square of a change is measured in joules, impulse^2 / effective mass of its row: rows of different units
 * (normal and friction N s, twist N m s) can be added so, and it is the product that conjugate gradients preconditioned
 * by the diagonal take. Sums follow the fixed tree of parallel/reduce.h and beta never leaves the device.
 */
#ifndef TANDEM_SHARED_SOLVE_NNCG_H
#define TANDEM_SHARED_SOLVE_NNCG_H

#include "shared/solve/contact.h"

/* Places in nncg_state. */
enum { NNCG_SUM_BEFORE, NNCG_BETA };

/* A smaller change than this, in joules, is no direction to go on along; it also keeps the quotient normal. */
#define NNCG_LEAST R(1e-30)

/* Before the first sweep: nothing has changed yet, no direction. */
SHARED void nncg_begin_item(GLOBAL const row *constraint_normal_impulse, GLOBAL const row *constraint_friction_impulse,
                            GLOBAL const uint *counts, GLOBAL row *nncg_impulse, GLOBAL row *nncg_direction,
                            item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_row(nncg_impulse, i, load_row(constraint_normal_impulse, i));
  store_row(nncg_impulse, stride + i, load_row(constraint_friction_impulse, i));
  store_row(nncg_direction, i, zero);
  store_row(nncg_direction, stride + i, zero);
}

SHARED real energy_of(real change, real mass)
{
  mask used = mass > R(0.0);
  return choose(used, change * change / choose(used, mass, (real)R(1.0)), (real)R(0.0));
}

/* After a sweep: the square of what it changed at this manifold. */
SHARED void nncg_change_item(GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                             GLOBAL const row *constraint_normal_impulse, GLOBAL const row *constraint_friction_impulse,
                             GLOBAL const row *nncg_impulse, GLOBAL const uint *counts, GLOBAL memory_real *nncg_square,
                             item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  vec4 pushes = load_row(constraint_normal_impulse, i), old = load_row(nncg_impulse, i);
  vec4 friction = load_row(constraint_friction_impulse, i), old_friction = load_row(nncg_impulse, stride + i);
  real slide_mass = load_row(constraint_center, i).w, twist_mass = load_row(constraint_center, stride + i).w;
  real sum = energy_of(friction.x - old_friction.x, slide_mass) + energy_of(friction.y - old_friction.y, slide_mass) +
             energy_of(friction.z - old_friction.z, twist_mass);
  for (uint k = 0; k < 4u; ++k)
    sum = sum + energy_of(component(pushes, (natural)k) - component(old, (natural)k),
                          load_row(constraint_points, stride * (k + 4u) + i).w);
  store_real(nncg_square, i, sum);
}

/* begins: the first sweep of a series, which has no change before it. */
SHARED void nncg_beta_item(GLOBAL const memory_real *nncg_sum, GLOBAL memory_real *nncg_state, uint begins, uint only)
{
  (void)only;
  memory_real sum = nncg_sum[0], before = nncg_state[NNCG_SUM_BEFORE];
  int goes_on = begins == 0u && before > NNCG_LEAST && sum <= before;
  nncg_state[NNCG_BETA] = goes_on ? sum / before : R(0.0);
  nncg_state[NNCG_SUM_BEFORE] = sum;
}

SHARED vec4 scale4(vec4 v, real s) { return make_vec4(v.x * s, v.y * s, v.z * s, v.w * s); }
SHARED vec4 add4(vec4 a, vec4 b) { return make_vec4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }

SHARED vec4 change_between(vec4 before, vec4 now)
{
  return make_vec4(now.x - before.x, now.y - before.y, now.z - before.z, now.w - before.w);
}

/* Goes on along the direction, with impulses and velocities alike. The twist radius, w of friction, never changes. */
SHARED void nncg_advance_item(read_contacts contacts, read_patches patches, GLOBAL const row *solver_inertia,
                              GLOBAL const row *solver_delta, GLOBAL const memory_real *nncg_state,
                              GLOBAL const uint *counts, GLOBAL row *constraint_normal_impulse,
                              GLOBAL row *constraint_friction_impulse, GLOBAL row *nncg_impulse,
                              GLOBAL row *nncg_direction, GLOBAL row *solver_velocity, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  real beta = nncg_state[NNCG_BETA];
  vec4 pushes = load_row(constraint_normal_impulse, i), friction = load_row(constraint_friction_impulse, i);
  vec4 push_step = scale4(load_row(nncg_direction, i), beta),
       friction_step = scale4(load_row(nncg_direction, stride + i), beta);
  store_row(nncg_direction, i, add4(push_step, change_between(load_row(nncg_impulse, i), pushes)));
  store_row(nncg_direction, stride + i,
            add4(friction_step, change_between(load_row(nncg_impulse, stride + i), friction)));
  pushes = add4(pushes, push_step);
  friction = add4(friction, friction_step);
  store_row(nncg_impulse, i, pushes);
  store_row(nncg_impulse, stride + i, friction);
  store_row(constraint_normal_impulse, i, pushes);
  store_row(constraint_friction_impulse, i, friction);

  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  arm_shift shift = load_arm_shift(solver_delta, c);
  support s = load_support(patches.points, stride, c, shift, push_step, i);
  vec3 center_a = add(xyz(load_row(patches.center, i)), shift.a),
       center_b = add(xyz(load_row(patches.center, stride + i)), shift.b);
  wrench w = wrench_of(c, s, center_a, center_b, friction_step);
  store_contact_motion(solver_velocity, apply_impulse(c, w.impulse, w.turn_a, w.turn_b, R(1.0)));
}

#endif
