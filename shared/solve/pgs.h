/* pgs.h - projected Gauss-Seidel on velocities, row by row, a batch at a time.
 *
 * The order of rows follows the talks, whose constraint solver consists of two kernels over all batches, contact and
 * friction ("GPU Rigid Body Simulation", 2013; GS-4150, 2013; for solving in batches and warm starting from cached
 * contacts, "OpenCL Game Physics", 2009). One pass is
 *
 *     for each colour: for each manifold: point 0, point 1, point 2, point 3    pgs_normals
 *     for each colour: for each manifold: twist, then the cone of sliding       pgs_friction
 *
 * so friction always uses the normal impulses of its own pass. Each point is a row of its own and starts from the
 * velocities that the points before it left. Only the cone differs from the talks, which clamp the two tangents one by
 * one.
 *
 *     normal:    impulse = max(impulse - mass (speed + bias), 0)
 *     apart:     bias = s / h             the gap s may close within the substep, and no more
 *     overlap:   bias = share (s + slop) / h, at most the push speed (Baumgarte)
 *
 * Baumgarte's bias alone would leave bodies with the speed that separated them. The bodies therefore move with the
 * bias, and then passes without it remove the speed that it added. The impulses kept for the next step are those of the
 * passes without bias.
 */
#ifndef TANDEM_SHARED_SOLVE_PGS_H
#define TANDEM_SHARED_SOLVE_PGS_H

#include "shared/solve/contact_friction.h"
#include "shared/solve/restitution.h"

/* The share of an overlap that a substep removes. */
#define PGS_BIAS_SHARE R(0.2)

/* The new accumulated impulse of a normal row. Without bias, a speculative point that has carried no impulse keeps
 * none, because the motion that it would limit comes later. */
SHARED real pgs_impulse(GLOBAL const Parameters *parameters, real slop_or_deep, real separation, real speed, real mass,
                        real old, uint biased)
{
  mask ahead = separation > R(0.0);
  real overlap = minimum(separation + slop_of(slop_or_deep), R(0.0));
  real push = maximum(PGS_BIAS_SHARE * parameters->inverse_substep * overlap, -push_limit(parameters, slop_or_deep));
  real bias = choose(ahead, separation * parameters->inverse_substep, biased != 0u ? push : (real)R(0.0));
  real impulse = maximum(old - mass * (speed + bias), R(0.0));
  return biased != 0u ? impulse : choose(ahead & (old == R(0.0)), old, impulse);
}

SHARED void pgs_normals_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                             GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                             GLOBAL const uint *counts, GLOBAL float4 *constraint_normal_impulse,
                             GLOBAL float4 *constraint_restitution, GLOBAL float4 *solver_velocity, uint pass,
                             item_index i)
{
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec4 old = load_float4(constraint_normal_impulse, i);
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  real closed = dot3(c.normal, moved.translation);
  real slop = load_real(patches.slop, i);
  vec4 offset = load_float4(patches.offset, i);
  real impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    vec3 arm_a = load_arm_of_a(patches.points, planes, k, i), arm_b = subtract(arm_a, xyz(offset));
    vec3 r_cross_n_a = cross3(add(arm_a, shift.a), c.normal), r_cross_n_b = cross3(add(arm_b, shift.b), c.normal);
    real separation = load_separation(patches.points, planes, k, i) + closed +
                      (dot3(r_cross_n_b, moved.rotation_b) - dot3(r_cross_n_a, moved.rotation_a));
    real before = component(old, (uint_lanes)k);
    impulse[k] = pgs_impulse(parameters, slop, separation, speed_along(c, c.normal, r_cross_n_a, r_cross_n_b),
                             load_point_mass(patches.points, planes, k, i), before, biased);
    c = apply_impulse(c, c.normal, r_cross_n_a, r_cross_n_b, impulse[k] - before);
  }
  vec4 normal_impulses = make_vec4(impulse[0], impulse[1], impulse[2], impulse[3]);
  store_float4(constraint_normal_impulse, i, normal_impulses);
  keep_highest_impulses(parameters, constraint_restitution, planes.stride, normal_impulses, i);
  store_contact_velocities(solver_velocity, c);
}

SHARED void pgs_friction_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                              GLOBAL const float4 *constraint_normal_impulse, GLOBAL const float4 *solver_inertia,
                              GLOBAL const float4 *solver_delta_pose, GLOBAL float4 *constraint_friction_impulse,
                              GLOBAL float4 *solver_velocity, item_index i)
{
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  mask rough = c.friction > R(0.0);
  if (!any_of(rough)) return;
  vec4 normal_impulses = load_float4(constraint_normal_impulse, i);
  real normal_impulse_sum = (normal_impulses.x + normal_impulses.y) + (normal_impulses.z + normal_impulses.w);
  mask stale = rough & (!rough); /* pgs_masses has just made them */
  vec4 center_a = load_float4(patches.center, i), center_b = center_of_b(center_a, load_float4(patches.offset, i));
  solved sliding = solve_friction(c, stale, load_arm_shift(solver_delta_pose, c), center_a, center_b,
                                  load_float4(constraint_friction_impulse, i), normal_impulse_sum);
  store_float4_if(rough, constraint_friction_impulse, i, sliding.impulse);
  store_contact_velocities(solver_velocity, with_velocities_if(rough, c, sliding.c));
}

/* Recomputes the effective masses at the current poses. Many passes with the masses of another pose do not converge: if
 * a long body has turned, a row whose mass is more than twice the right one doubles its error in every pass. */
SHARED void pgs_masses_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                            read_solver_bodies solver_bodies, GLOBAL const uint *counts,
                            GLOBAL memory_real *constraint_points, GLOBAL float4 *constraint_center,
                            GLOBAL float4 *constraint_offset, item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_bodies.velocity, solver_bodies.inertia, i);
  body_pair bodies = bodies_of(c);
  vec4 offset = load_float4(constraint_offset, i);
  arm_shift shift = load_arm_shift(solver_bodies.delta, c);
  for (uint k = 0; k < planes.points; ++k) {
    vec3 arm_a = load_arm_of_a(constraint_points, planes, k, i), arm_b = subtract(arm_a, xyz(offset));
    real mass = normal_mass(bodies, add(arm_a, shift.a), add(arm_b, shift.b), c.normal);
    store_point_mass_if(load_point_mass(constraint_points, planes, k, i) > R(0.0), constraint_points, planes, k, i,
                        mass);
  }
  vec4 center = load_float4(constraint_center, i);
  vec3 center_a = xyz(center), center_b = xyz(center_of_b(center, offset));
  store_float4(constraint_center, i,
               extend(center_a, friction_mass(bodies, add(center_a, shift.a), add(center_b, shift.b), c.normal)));
  store_float4(constraint_offset, i, extend(xyz(offset), twist_mass(bodies, c.normal)));
}

#endif
