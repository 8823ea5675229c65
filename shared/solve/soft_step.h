/* soft_step.h - the soft-step contact solver: projected Gauss-Seidel over one colour at a time.
 *
 * Each substep: warm start, solve with soft bias, move bodies, solve again without bias (relax). The bias pushes what
 * overlaps apart; relaxing takes its velocity out again. Impacts of fast bodies have more rounds.
 *
 * After Catto, "Soft Contact" and "Substepping" (Box2D version 3, Solver2D, 2024); Macklin et al., "Small Steps in
 * Physics Simulation", 2019. Constraints of one colour share no moving body.
 */
#ifndef TANDEM_SHARED_SOLVE_SOFT_STEP_H
#define TANDEM_SHARED_SOLVE_SOFT_STEP_H

#include "shared/solve/restitution.h"
#include "shared/solve/warm_start.h"

/* Further passes over the points of an impact. The points are coupled, and a single pass would leave a fast body
 * moving; these bring all points to rest. */
#define IMPACT_ROUNDS 15u

/* Solves the contacts of an impact further, after the pass that all contacts get. Everything is loaded once more,
 * because few contacts belong to an impact, and the others need not pay registers for it. */
SHARED void settle_impact(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                          GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                          point_planes planes, write_contact_impulses contact_impulses, GLOBAL float4 *solver_velocity,
                          GLOBAL float4 *warm_start_impulse, uint pass, item_index i)
{
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  mask at_impact = c.follows == R(0.0);
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  vec4 before = load_float4(contact_impulses.normal, i);
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  normal_rows s = load_normal_rows(patches.points, planes, c, offset, shift, before, i);
  real slop = load_real(patches.slop, i);
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  for (uint round = 0; round < IMPACT_ROUNDS; ++round)
    c = solve_normals(parameters, c, &s, moved, patches.points, planes, slop, biased, i);
  vec4 normal_impulses = impulses_of(&s);
  store_float4_if(at_impact, contact_impulses.normal, i, normal_impulses);
  keep_highest_impulses_if(at_impact, parameters, contact_impulses.restitution, planes.stride, normal_impulses, i);
  vec4 changes = make_vec4(normal_impulses.x - before.x, normal_impulses.y - before.y, normal_impulses.z - before.z,
                           normal_impulses.w - before.w);
  c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  c = apply_changes(c, &s, changes);
  store_contact_velocities_if(at_impact, solver_velocity, c);
  if (pass == PASS_RELAXING)
    hand_on_impulses_if(at_impact, parameters, contact_impulses, warm_start_impulse, c, s,
                        load_friction(parameters, contact_impulses.friction, i), moved, shift, center,
                        center_of_b(center, offset), i);
}

SHARED void solve_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                                GLOBAL const uint *counts, write_contact_impulses contact_impulses,
                                GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                item_index i)
{
  point_planes planes = planes_of(counts);
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec4 impulses = load_float4(contact_impulses.normal, i),
       friction = load_friction(parameters, contact_impulses.friction, i);
  vec4 offset = load_float4(patches.offset, i), center_a = load_float4(patches.center, i),
       center_b = center_of_b(center_a, offset);
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  mask rough = c.friction > R(0.0);
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    mask stale = masses_are_stale(moved, shift, center_a, center_b);
    solved sliding = solve_friction(c, stale, shift, center_a, center_b, friction, sum_of_points(impulses));
    c = with_velocities_if(rough, c, sliding.c);
    friction = choose4(rough, sliding.impulse, friction);
    store_float4(contact_impulses.friction, i, friction);
  }

  real slop = load_real(patches.slop, i);
  normal_rows s = load_normal_rows(patches.points, planes, c, offset, shift, impulses, i);
  c = solve_normals(parameters, c, &s, moved, patches.points, planes, slop, biased, i);
  vec4 normal_impulses = impulses_of(&s);
  store_float4(contact_impulses.normal, i, normal_impulses);
  keep_highest_impulses(parameters, contact_impulses.restitution, planes.stride, normal_impulses, i);
  store_contact_velocities(solver_velocity, c);
  mask at_impact = c.follows == R(0.0);
  if (pass == PASS_RELAXING)
    hand_on_impulses_if(!at_impact, parameters, contact_impulses, warm_start_impulse, c, s, friction, moved, shift,
                        center_a, center_b, i);
  if (any_of(at_impact))
    settle_impact(parameters, contacts, patches, solver_inertia, solver_delta_pose, planes, contact_impulses,
                  solver_velocity, warm_start_impulse, pass, i);
}

#endif
