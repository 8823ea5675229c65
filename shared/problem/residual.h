/* residual.h - how far the impulses of a friction problem are from its solution, contact by contact.
 *
 * There are three measures, which are 0 at a solution and nowhere else (the third one in the cone and nowhere else);
 * docs/contact-problems.md defines and explains them. Each contact writes its term, and a fixed tree adds the terms
 * (shared/parallel/reduce.h).
 *
 *   natural map         | r - P_K(r - rho (u + mu |u_T| n)) |^2
 *   Fischer-Burmeister  | x + y - (x o x + y o y)^(1/2) |^2,   x = (mu r_n, r_T), y = rho (u_n + mu |u_T|, mu u_T),
 *                       o = Jordan product of the second-order cone (Fukushima, Luo and Tseng 2002)
 *   violation           how far r lies outside its cone, as a friction impulse
 */
#ifndef TANDEM_SHARED_PROBLEM_RESIDUAL_H
#define TANDEM_SHARED_PROBLEM_RESIDUAL_H

#include "shared/counts.h"
#include "shared/problem/friction_problem.h"

/* rho converts a velocity to an impulse: RHO_FACTOR over the mean of the diagonal of W. */
#define RHO_FACTOR R(10.0)
SHARED real rho_of(GLOBAL const uint *counts, GLOBAL const memory_real *problem_trace)
{
  return RHO_FACTOR * R(3.0) * to_real(counts[COUNT_LENGTH]) / problem_trace[0];
}

SHARED real natural_term(vec3 impulse, vec3 velocity, real friction, real rho)
{
  vec3 target = add_scaled(impulse, corrected_velocity(velocity, friction), -rho);
  return length_squared(subtract(impulse, project_on_cone(target, friction)));
}

/* x + y - (x o x + y o y)^(1/2). The square lies in the cone, and its eigenvalues are head +- |tail|. */
SHARED vec3 fischer_burmeister(vec3 x, vec3 y)
{
  real head = dot3(x, x) + dot3(y, y);
  real first = R(2.0) * (x.x * x.y + y.x * y.y), second = R(2.0) * (x.x * x.z + y.x * y.z);
  real tail = square_root(first * first + second * second);
  real upper = square_root(head + tail), lower = square_root(maximum(head - tail, R(0.0)));
  real factor = R(0.5) * (upper - lower) / choose(tail > R(0.0), tail, (real)R(1.0));
  vec3 root = make_vec3(R(0.5) * (upper + lower), first * factor, second * factor);
  return subtract(add(x, y), root);
}

/* Without friction the cone is a ray, and the function is that of one number and the tangent impulse itself. */
SHARED real fischer_term(vec3 impulse, vec3 velocity, real friction, real rho)
{
  vec3 v = scale(corrected_velocity(velocity, friction), rho);
  real sum = impulse.x + v.x, alone = sum - square_root(impulse.x * impulse.x + v.x * v.x);
  real without = alone * alone + (impulse.y * impulse.y + impulse.z * impulse.z);
  vec3 x = make_vec3(friction * impulse.x, impulse.y, impulse.z), y = make_vec3(v.x, friction * v.y, friction * v.z);
  return choose(friction > R(0.0), length_squared(fischer_burmeister(x, y)), without);
}

SHARED void problem_residual_item(GLOBAL const uint *counts, GLOBAL const uint *problem_start,
                                  GLOBAL const uint *problem_column, GLOBAL const float4 *problem_block,
                                  GLOBAL const float4 *problem_free, GLOBAL const memory_real *problem_trace,
                                  GLOBAL const float4 *impulse, GLOBAL memory_real *natural_map,
                                  GLOBAL memory_real *fischer, GLOBAL memory_real *violation, uint i)
{
  vec4 q = load_float4(problem_free, i);
  vec3 r = xyz(load_float4(impulse, i));
  vec3 u = velocity_of(problem_start, problem_column, problem_block, xyz(q), impulse, i);
  real rho = rho_of(counts, problem_trace);
  natural_map[i] = natural_term(r, u, q.w, rho);
  fischer[i] = fischer_term(r, u, q.w, rho);
  violation[i] = maximum(tangent_length(r) - q.w * maximum(r.x, R(0.0)), maximum(-r.x, R(0.0)));
}

#endif
