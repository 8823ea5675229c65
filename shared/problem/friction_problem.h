/* friction_problem.h - one frictional contact problem: impulses in Coulomb cones, coupled by the Delassus operator W.
 *
 *   u = W r + q,   K* contains  u + mu |u_T| n,   perpendicular to   r in K,    K = { |r_T| <= mu r_n }
 *
 *            n                 The problem is separate from its simulation: it has contacts, but no bodies. x of a
 *       \    |    /            vector is the normal, y and z are the tangents. W is stored in rows of 3x3 blocks, the
 *        \ K |   /             contact's own first: blocks problem_start[i] .. problem_start[i + 1] - 1 of three rows.
 *         \  |  /   slope of
 *          \ | /    the side: 1 / mu
 *     ------\|/------ T
 *
 * The correction mu |u_T| of the normal velocity is that of De Saxce and Feng ("The bipotential method", 1998). It
 * turns Coulomb's law into a complementarity on a cone. The formulation follows Acary, Bremond and Huber, "On solving
 * contact problems with Coulomb friction: formulations and numerical comparisons" (2018), whose problems are used.
 */
#ifndef TANDEM_SHARED_PROBLEM_FRICTION_PROBLEM_H
#define TANDEM_SHARED_PROBLEM_FRICTION_PROBLEM_H

#include "shared/math.h"

typedef struct {
  vec3 normal, first, second;
} delassus_block; /* rows of a 3x3 block of W */

SHARED delassus_block load_block(GLOBAL const float4 *problem_block, uint block)
{
  delassus_block b = {xyz(load_float4(problem_block, 3u * block)), xyz(load_float4(problem_block, 3u * block + 1u)),
                      xyz(load_float4(problem_block, 3u * block + 2u))};
  return b;
}
SHARED vec3 block_times(delassus_block b, vec3 v)
{
  return make_vec3(dot3(b.normal, v), dot3(b.first, v), dot3(b.second, v));
}

/* The velocity of contact i under all impulses, summed in the order of its row of blocks. */
SHARED vec3 velocity_of(GLOBAL const uint *problem_start, GLOBAL const uint *problem_column,
                        GLOBAL const float4 *problem_block, vec3 free_velocity, GLOBAL const float4 *impulse, uint i)
{
  vec3 velocity = free_velocity;
  for (uint k = problem_start[i]; k < problem_start[i + 1u]; ++k)
    velocity = add(velocity, block_times(load_block(problem_block, k), xyz(load_float4(impulse, problem_column[k]))));
  return velocity;
}

SHARED real tangent_length(vec3 v) { return square_root(v.y * v.y + v.z * v.z); }

/* The velocity whose complementarity with r on the cone is Coulomb's law. */
SHARED vec3 corrected_velocity(vec3 velocity, real friction)
{
  return make_vec3(velocity.x + friction * tangent_length(velocity), velocity.y, velocity.z);
}

/* Scales friction down to the limit that the normal impulse gives. */
SHARED vec3 limit_friction(vec3 impulse, real friction)
{
  real length = tangent_length(impulse), limit = friction * impulse.x;
  mask over = length > limit;
  real factor = choose(over, limit / choose(over, length, (real)R(1.0)), (real)R(1.0));
  return make_vec3(impulse.x, impulse.y * factor, impulse.z * factor);
}

/* The nearest point of the cone K. */
SHARED vec3 project_on_cone(vec3 v, real friction)
{
  real length = tangent_length(v);
  mask inside = length <= friction * v.x, polar = friction * length <= -v.x;
  real normal = (v.x + friction * length) / (R(1.0) + friction * friction);
  real factor = friction * normal / choose(length > R(0.0), length, (real)R(1.0));
  vec3 nearest = make_vec3(normal, v.y * factor, v.z * factor), apex = make_vec3(R(0.0), R(0.0), R(0.0));
  return choose3(inside, v, choose3(polar, apex, nearest));
}

#endif
