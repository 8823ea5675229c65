/* restitution.h - points that carried an impulse in the step get their target velocity after its last substep.
 *
 * Within the substeps the relaxing pass would take the speed of a bounce out again.
 */
#ifndef TANDEM_SHARED_SOLVE_RESTITUTION_H
#define TANDEM_SHARED_SOLVE_RESTITUTION_H

#include "shared/solve/contact_normals.h"

/* The highest impulse that each point has carried within the step. Only points that carried an impulse bounce. */
SHARED vec4 highest_impulses(vec4 highest, vec4 normal_impulses)
{
  return make_vec4(maximum(highest.x, normal_impulses.x), maximum(highest.y, normal_impulses.y),
                   maximum(highest.z, normal_impulses.z), maximum(highest.w, normal_impulses.w));
}

SHARED void keep_highest_impulses(GLOBAL const Parameters *parameters, GLOBAL float4 *constraint_restitution,
                                  uint stride, vec4 normal_impulses, item_index i)
{
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_float4(constraint_restitution, stride + i,
                 highest_impulses(load_float4(constraint_restitution, stride + i), normal_impulses));
}

SHARED void keep_highest_impulses_if(mask wanted, GLOBAL const Parameters *parameters,
                                     GLOBAL float4 *constraint_restitution, uint stride, vec4 normal_impulses,
                                     uint_lanes i)
{
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_float4_if(wanted, constraint_restitution, stride + i,
                    highest_impulses(load_float4(constraint_restitution, stride + i), normal_impulses));
}

/* Towards the target velocity of a point that has carried an impulse in the step; other points keep theirs. highest: of
 * constraint_restitution. */
SHARED real bouncing_impulse(real target_velocity, real highest, real speed, real mass, real impulse)
{
  mask bounces = (target_velocity >= R(0.0)) & (highest > R(0.0));
  return choose(bounces, impulse - mass * (speed - target_velocity), impulse);
}

/* The points of a manifold are coupled; a few rounds bring all of them to their speeds. */
#define RESTITUTION_ROUNDS 8u

/* After the last substep, points that carried an impulse get their target velocity. */
SHARED void apply_restitution_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                   GLOBAL const float4 *constraint_restitution, GLOBAL const float4 *solver_inertia,
                                   GLOBAL const float4 *solver_delta_pose, GLOBAL const uint *counts,
                                   GLOBAL float4 *constraint_normal_impulse, GLOBAL float4 *solver_velocity,
                                   item_index i)
{
  point_planes planes = planes_of(counts);
  vec4 target_velocity = load_float4(constraint_restitution, i),
       highest = load_float4(constraint_restitution, planes.stride + i);
  mask bounces = (target_velocity.x >= R(0.0)) | (target_velocity.y >= R(0.0)) | (target_velocity.z >= R(0.0)) |
                 (target_velocity.w >= R(0.0));
  if (!any_of(bounces)) return;
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  contact before = c;
  vec4 impulses = load_float4(constraint_normal_impulse, i);
  arm_shift shift = load_arm_shift(solver_delta_pose, c);
  normal_rows s = load_normal_rows(patches.points, planes, c, load_float4(patches.offset, i), shift, impulses, i);
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) {
    real normal_impulses[4];
    for (uint k = 0; k < 4u; ++k) {
      real speed = speed_along(c, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k]);
      normal_impulses[k] = bouncing_impulse(component(target_velocity, (uint_lanes)k),
                                            component(highest, (uint_lanes)k), speed, s.mass[k], s.impulse[k]);
    }
    c = block_solve_normals(c, &s, normal_impulses);
  }
  store_float4_if(bounces, constraint_normal_impulse, i, impulses_of(&s));
  store_contact_velocities(solver_velocity, with_velocities_if(bounces, before, c));
}

#endif
