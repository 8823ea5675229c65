/* pass.h - one pass over the contacts of a friction problem: Gauss-Seidel, Jacobi, and the conjugate step over either.
 *
 * problem_pass is a projected Gauss-Seidel pass in the order of the contacts, parallelised without changing that order.
 * The host sorts contacts into levels, 1 + the highest level among lower-numbered neighbours, and launches level by
 * level. Within a level no contact reads what another one writes, so the bits are those of the plain loop:
 *
 *   contact   0   1   2   3   4      0-1, 1-2, 3-4 coupled
 *   level     0   1   2   0   1      launches: {0, 3} {1, 4} {2}
 *
 * problem_jacobi solves all contacts at once, each by a share (Tonge, Benevolenski and Voroshilov, "Mass Splitting for
 * Jitter-Free Parallel Rigid Body Simulation", 2012). With bodies, each contact would own 1/n of a body's mass. Here
 * only W is known, so the share follows from the couplings of its blocks.
 *
 * problem_conjugate is the step of the nonsmooth nonlinear conjugate gradient method over a pass (Silcowitz, Niebe and
 * Erleben, 2010): the change by a pass takes the place of the negative gradient, directions are combined after Fletcher
 * and Reeves, and a change that grows restarts the method.
 */
#ifndef TANDEM_SHARED_PROBLEM_PASS_H
#define TANDEM_SHARED_PROBLEM_PASS_H

#include "shared/problem/friction_problem.h"

SHARED real block_size(delassus_block b)
{
  return square_root(dot3(b.normal, b.normal) + dot3(b.first, b.first) + dot3(b.second, b.second));
}

/* problem_step: the normal mass, the tangent mass, and the share of a pass that solves all contacts at once. The
 * tangent mass is 1 / the trace of the 2x2 block, which the response along no direction exceeds. */
SHARED void problem_prepare_item(GLOBAL const uint *problem_start, GLOBAL const uint *problem_column,
                                 GLOBAL const float4 *problem_block, GLOBAL const float4 *problem_free,
                                 GLOBAL float4 *problem_step, GLOBAL memory_real *trace, GLOBAL memory_real *reference,
                                 uint i)
{
  const uint own = problem_start[i];
  delassus_block b = load_block(problem_block, own);
  real coupling = R(1.0), own_size = block_size(b);
  for (uint k = own + 1u; k < problem_start[i + 1u]; ++k) {
    real size = block_size(load_block(problem_block, k));
    real other = block_size(load_block(problem_block, problem_start[problem_column[k]]));
    coupling = coupling + size / square_root(own_size * other);
  }
  store_float4(problem_step, i,
               make_vec4(R(1.0) / b.normal.x, R(1.0) / (b.first.y + b.second.z), R(1.0) / coupling, R(0.0)));
  trace[i] = b.normal.x + b.first.y + b.second.z;
  vec4 q = load_float4(problem_free, i);
  reference[i] = length_squared(corrected_velocity(xyz(q), q.w));
}

/* Solves friction within the limit of the current normal impulse, then the normal impulse, which may lower the
 * limit. */
SHARED vec3 solve_contact(delassus_block own, vec4 step, real share, real friction, vec3 velocity, vec3 impulse)
{
  real tangent_step = step.y * share;
  vec3 slid = limit_friction(
      make_vec3(impulse.x, impulse.y - velocity.y * tangent_step, impulse.z - velocity.z * tangent_step), friction);
  real normal_velocity = velocity.x + (own.normal.y * (slid.y - impulse.y) + own.normal.z * (slid.z - impulse.z));
  slid.x = maximum(slid.x - normal_velocity * (step.x * share), R(0.0));
  return limit_friction(slid, friction);
}

SHARED void solve_problem_contact(GLOBAL const uint *problem_start, GLOBAL const uint *problem_column,
                                  GLOBAL const float4 *problem_block, GLOBAL const float4 *problem_free,
                                  GLOBAL const float4 *problem_step, GLOBAL const float4 *from, GLOBAL float4 *to,
                                  mask all_at_once, uint i)
{
  vec4 q = load_float4(problem_free, i), step = load_float4(problem_step, i);
  vec3 velocity = velocity_of(problem_start, problem_column, problem_block, xyz(q), from, i);
  vec3 impulse = solve_contact(load_block(problem_block, problem_start[i]), step,
                               choose(all_at_once, step.z, (real)R(1.0)), q.w, velocity, xyz(load_float4(from, i)));
  store_float4(to, i, extend(impulse, R(0.0)));
}

SHARED void problem_pass_item(GLOBAL const uint *problem_order, GLOBAL const uint *problem_start,
                              GLOBAL const uint *problem_column, GLOBAL const float4 *problem_block,
                              GLOBAL const float4 *problem_free, GLOBAL const float4 *problem_step,
                              GLOBAL float4 *problem_impulse, uint i)
{
  solve_problem_contact(problem_start, problem_column, problem_block, problem_free, problem_step, problem_impulse,
                        problem_impulse, 0, problem_order[i]);
}

SHARED void problem_jacobi_item(GLOBAL const uint *problem_start, GLOBAL const uint *problem_column,
                                GLOBAL const float4 *problem_block, GLOBAL const float4 *problem_free,
                                GLOBAL const float4 *problem_step, GLOBAL const float4 *from, GLOBAL float4 *to, uint i)
{
  solve_problem_contact(problem_start, problem_column, problem_block, problem_free, problem_step, from, to, 1, i);
}

/* The square of the change by a pass, in the metric in which the pass descends: it is divided by the steps, so that
 * normal and tangents are weighted by their masses. */
SHARED void problem_change_item(GLOBAL const float4 *problem_step, GLOBAL const float4 *problem_impulse,
                                GLOBAL const float4 *problem_previous, GLOBAL memory_real *change, uint i)
{
  vec4 step = load_float4(problem_step, i);
  vec3 moved = subtract(xyz(load_float4(problem_impulse, i)), xyz(load_float4(problem_previous, i)));
  change[i] = moved.x * moved.x / step.x + (moved.y * moved.y + moved.z * moved.z) / step.y;
}

/* now, before: the squared changes of this pass and of the one before; the first pass has none before it. */
SHARED void problem_conjugate_item(GLOBAL const memory_real *now, GLOBAL const memory_real *before,
                                   GLOBAL float4 *problem_impulse, GLOBAL float4 *problem_previous,
                                   GLOBAL float4 *problem_direction, uint first_pass, uint i)
{
  vec3 impulse = xyz(load_float4(problem_impulse, i));
  vec3 change = subtract(impulse, xyz(load_float4(problem_previous, i)));
  vec3 direction = make_vec3(R(0.0), R(0.0), R(0.0));
  if (first_pass != 0u) direction = change;
  else if (now[0] <= before[0] && before[0] > R(0.0)) {
    vec3 kept = scale(xyz(load_float4(problem_direction, i)), now[0] / before[0]);
    impulse = add(impulse, kept);
    direction = add(kept, change);
  }
  store_float4(problem_impulse, i, extend(impulse, R(0.0)));
  store_float4(problem_previous, i, extend(impulse, R(0.0)));
  store_float4(problem_direction, i, extend(direction, R(0.0)));
}

#endif
