/* nncg.h - the nonsmooth nonlinear conjugate gradient method over the passes of pgs.h.
 *
 * Silcowitz, Niebe and Erleben, "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force
 * Problems", The Visual Computer 26, 2010. A pass of projected Gauss-Seidel maps all impulses x to PGS(x), and
 * x - PGS(x) takes the place of the gradient in the method of Fletcher and Reeves:
 *
 *     change = PGS(x) - x                             the change by the pass
 *     beta   = |change|^2 / |change before|^2         0 at first, and in place of values above 1: a restart
 *     x      = PGS(x) + beta direction                impulses, and velocities by the arithmetic of warm starting
 *     direction = beta direction + change
 *
 * The last operation is a pass, so the resulting impulses lie in their cones.
 *
 * The square of a change is measured in joules: impulse^2 / effective mass of its row. Rows of different units (normal
 * and friction N s, twist N m s) can then be added, and it is the inner product of conjugate gradients with the
 * diagonal as preconditioner. Sums follow the fixed tree of parallel/reduce.h, and beta never leaves the device.
 */
#ifndef TANDEM_SHARED_SOLVE_NNCG_H
#define TANDEM_SHARED_SOLVE_NNCG_H

#include "shared/solve/contact.h"
#include "shared/solve/nncg_state.h"

/* A change smaller than this, in joules, gives no direction. The bound also keeps the quotient a normal number. */
#define NNCG_LEAST R(1e-30)

/* Before the first pass there is neither a change nor a direction. */
SHARED void nncg_begin_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *constraint_normal_impulse,
                            GLOBAL const float4 *constraint_friction_impulse, GLOBAL const uint *counts,
                            GLOBAL float4 *nncg_impulse, GLOBAL float4 *nncg_direction, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(nncg_impulse, i, load_float4(constraint_normal_impulse, i));
  store_float4(nncg_direction, i, zero);
  store_friction(parameters, nncg_impulse, stride + i, load_friction(parameters, constraint_friction_impulse, i));
  store_friction(parameters, nncg_direction, stride + i, zero);
}

SHARED real energy_of(real change, real mass)
{
  mask used = mass > R(0.0);
  return choose(used, change * change / choose(used, mass, (real)R(1.0)), (real)R(0.0));
}

/* Computes, after a pass, the square of its change at this manifold. */
SHARED void nncg_change_item(GLOBAL const Parameters *parameters, read_patches patches,
                             GLOBAL const float4 *constraint_normal_impulse,
                             GLOBAL const float4 *constraint_friction_impulse, GLOBAL const float4 *nncg_impulse,
                             GLOBAL const uint *counts, GLOBAL memory_real *nncg_square, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  vec4 normal_impulses = load_float4(constraint_normal_impulse, i), old = load_float4(nncg_impulse, i);
  vec4 friction = load_friction(parameters, constraint_friction_impulse, i),
       old_friction = load_friction(parameters, nncg_impulse, stride + i);
  real slide_mass = load_float4(patches.center, i).w, twist_mass = load_float4(patches.offset, i).w;
  real sum = energy_of(friction.x - old_friction.x, slide_mass) + energy_of(friction.y - old_friction.y, slide_mass) +
             energy_of(friction.z - old_friction.z, twist_mass);
  for (uint k = 0; k < 4u; ++k)
    sum = sum + energy_of(component(normal_impulses, (uint_lanes)k) - component(old, (uint_lanes)k),
                          load_point_mass(patches.points, planes_of(counts), k, i));
  store_real(nncg_square, i, sum);
}

/* begins: whether the pass is the first of a series, which has no change before it. */
SHARED void nncg_beta_item(GLOBAL const Parameters *parameters, GLOBAL const memory_real *nncg_sum,
                           GLOBAL const memory_real *nncg_joint_sum, GLOBAL memory_real *nncg_state, uint begins,
                           uint only)
{
  (void)only;
  memory_real sum = nncg_sum[0], before = nncg_state[NNCG_SUM_BEFORE];
  if (HAS_FEATURE(parameters, JOINTS)) sum = sum + nncg_joint_sum[0];
  int goes_on = begins == 0u && before > NNCG_LEAST && sum <= before;
  nncg_state[NNCG_BETA] = goes_on ? sum / before : R(0.0);
  nncg_state[NNCG_SUM_BEFORE] = sum;
}

/* Continues along the direction, for impulses and velocities alike. The twist radius, w of friction, never changes. */
SHARED void nncg_advance_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                              GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                              GLOBAL const memory_real *nncg_state, GLOBAL const uint *counts,
                              GLOBAL float4 *constraint_normal_impulse, GLOBAL float4 *constraint_friction_impulse,
                              write_nncg_rows nncg_rows, GLOBAL float4 *solver_velocity, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  real beta = nncg_state[NNCG_BETA];
  vec4 normal_impulses = load_float4(constraint_normal_impulse, i),
       friction = load_friction(parameters, constraint_friction_impulse, i);
  vec4 normal_step = scale4(load_float4(nncg_rows.direction, i), beta),
       friction_step = scale4(load_friction(parameters, nncg_rows.direction, stride + i), beta);
  store_float4(nncg_rows.direction, i,
               add4(normal_step, change_between(load_float4(nncg_rows.impulse, i), normal_impulses)));
  store_friction(
      parameters, nncg_rows.direction, stride + i,
      add4(friction_step, change_between(load_friction(parameters, nncg_rows.impulse, stride + i), friction)));
  normal_impulses = add4(normal_impulses, normal_step);
  friction = add4(friction, friction_step);
  store_float4(nncg_rows.impulse, i, normal_impulses);
  store_friction(parameters, nncg_rows.impulse, stride + i, friction);
  store_float4(constraint_normal_impulse, i, normal_impulses);
  store_friction(parameters, constraint_friction_impulse, i, friction);

  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  arm_shift shift = load_arm_shift(solver_delta_pose, c);
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  normal_rows s = load_normal_rows(patches.points, planes_of(counts), c, offset, shift, normal_step, i);
  wrench w = wrench_of(c, s, add(xyz(center), shift.a), add(xyz(center_of_b(center, offset)), shift.b), friction_step);
  store_contact_velocities(solver_velocity,
                           apply_impulse(c, w.impulse, w.angular_impulse_a, w.angular_impulse_b, R(1.0)));
}

#endif
