/* warm_start.h - the impulses with which contacts begin: those of the step before, and of the substep before.
 *
 * The last pass of a substep gathers for each body what its constraints will apply in the next one. Bodies that turn by
 * radians within a step are given no more than their masses allow.
 */
#ifndef TANDEM_SHARED_SOLVE_WARM_START_H
#define TANDEM_SHARED_SOLVE_WARM_START_H

#include "shared/solve/contact_friction.h"
#include "shared/solve/contact_normals.h"

/* Applies the impulses of the last step in the first substep. Later substeps find theirs in warm_start_impulse. */
SHARED void warm_start_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                            GLOBAL const float4 *constraint_normal_impulse,
                            GLOBAL const float4 *constraint_friction_impulse, GLOBAL const float4 *solver_inertia,
                            GLOBAL const float4 *solver_delta_pose, GLOBAL const uint *counts,
                            GLOBAL float4 *solver_velocity, item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  arm_shift shift = load_arm_shift(solver_delta_pose, c);
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  normal_rows s =
      load_normal_rows(patches.points, planes, c, offset, shift, load_float4(constraint_normal_impulse, i), i);
  wrench w = wrench_of(c, s, add(xyz(center), shift.a), add(xyz(center_of_b(center, offset)), shift.b),
                       load_friction(parameters, constraint_friction_impulse, i));
  store_contact_velocities(solver_velocity,
                           apply_impulse(c, w.impulse, w.angular_impulse_a, w.angular_impulse_b, R(1.0)));
}

/* Gathers the warm start of the next substep: the linear and the angular impulse that the constraints of each body will
 * apply, in the order of the colours. The last pass of this substep does it, because it has loaded all that it takes; a
 * pass of its own would read every constraint once more. */
SHARED void add_warm_start_impulse_if(mask wanted, GLOBAL float4 *warm_start_impulse, contact c, wrench w)
{
  mask moves_a = wanted & (c.velocity_a.inverse_mass > R(0.0)), moves_b = wanted & (c.velocity_b.inverse_mass > R(0.0));
  vec3 impulse_a = subtract(xyz(load_float4(warm_start_impulse, c.a * 2u)), w.impulse),
       angular_impulse_a = subtract(xyz(load_float4(warm_start_impulse, c.a * 2u + 1u)), w.angular_impulse_a);
  vec3 impulse_b = add(xyz(load_float4(warm_start_impulse, c.b * 2u)), w.impulse),
       angular_impulse_b = add(xyz(load_float4(warm_start_impulse, c.b * 2u + 1u)), w.angular_impulse_b);
  store_float4_if(moves_a, warm_start_impulse, c.a * 2u, extend(impulse_a, R(0.0)));
  store_float4_if(moves_a, warm_start_impulse, c.a * 2u + 1u, extend(angular_impulse_a, R(0.0)));
  store_float4_if(moves_b, warm_start_impulse, c.b * 2u, extend(impulse_b, R(0.0)));
  store_float4_if(moves_b, warm_start_impulse, c.b * 2u + 1u, extend(angular_impulse_b, R(0.0)));
}

/* A mobility that differs from that of the stored mass by more than this factor is that of a body that lies otherwise,
 * and not of arms that have followed a slide. */
#define OTHER_MOBILITY R(2.0)

/* Whether turning changes an inverse inertia in world axes. It is told from the tensor, because features that a scene
 * does not need change no bits. */
SHARED mask is_uneven_tensor(symmetric3 s)
{
  return (s.xx != s.yy) | (s.yy != s.zz) | (s.xy != R(0.0)) | (s.xz != R(0.0)) | (s.yz != R(0.0));
}

/* The square root of twice the energy that an impulse gives to a mass. */
SHARED real root_of_energy(real impulse, real mass)
{
  mask used = mass > R(0.0);
  return choose(used, impulse / square_root(choose(used, mass, (real)R(1.0))), (real)R(0.0));
}

/* How much of its impulses a contact hands on to the next substep. For the stored masses they cannot give more energy
 * than if all of them were along one direction. Bodies that have turned since may be lighter: a thin rod by up to a
 * thousand, if it was hit along its length and lies across now. friction_mass, twist_mass: as stored. */
SHARED real share_handed_on(contact c, normal_rows s, wrench w, vec4 friction, real friction_mass, real twist_mass)
{
  real root = root_of_energy(square_root(friction.x * friction.x + friction.y * friction.y), friction_mass) +
              root_of_energy(magnitude(friction.z), twist_mass);
  for (uint k = 0; k < 4u; ++k) root = root + root_of_energy(s.impulse[k], s.mass[k]);
  real whole = linear_response(bodies_of(c), w.impulse, w.impulse) +
               dot3(w.angular_impulse_a, symmetric_times(c.inertia_a, w.angular_impulse_a)) +
               dot3(w.angular_impulse_b, symmetric_times(c.inertia_b, w.angular_impulse_b));
  real most = OTHER_MOBILITY * root * root;
  mask too_much = whole > most;
  return choose(too_much, most / choose(too_much, whole, (real)R(1.0)), (real)R(1.0));
}

/* Adds the impulses of this substep to the warm start of the next one. */
SHARED void hand_on_impulses_if(mask wanted, GLOBAL const Parameters *parameters,
                                write_contact_impulses contact_impulses, GLOBAL float4 *warm_start_impulse, contact c,
                                normal_rows s, vec4 friction, delta_pose moved, arm_shift shift, vec4 center_a,
                                vec4 center_b, item_index i)
{
  wrench w = wrench_of(c, s, add(xyz(center_a), shift.a), add(xyz(center_b), shift.b), friction);
  mask uneven = is_uneven_tensor(c.inertia_a) | is_uneven_tensor(c.inertia_b);
  mask stale = wanted & uneven & masses_are_stale(moved, shift, center_a, center_b);
  if (HAS_FEATURE(parameters, GYROSCOPIC) && any_of(stale)) {
    real share = choose(stale, share_handed_on(c, s, w, friction, center_a.w, center_b.w), (real)R(1.0));
    mask less = share < R(1.0);
    w.impulse = scale(w.impulse, share);
    w.angular_impulse_a = scale(w.angular_impulse_a, share);
    w.angular_impulse_b = scale(w.angular_impulse_b, share);
    vec4 normal_impulses = impulses_of(&s);
    store_float4_if(less, contact_impulses.normal, i, scale4(normal_impulses, share));
    if (HAS_FEATURE(parameters, EVENTS))
      store_float4_if(less, contact_impulses.carried, i,
                      add_scaled4(load_float4(contact_impulses.carried, i), normal_impulses, R(1.0) - share));
    if (HAS_FEATURE(parameters, FRICTION))
      store_float4_if(less, contact_impulses.friction, i,
                      make_vec4(friction.x * share, friction.y * share, friction.z * share, friction.w));
  }
  add_warm_start_impulse_if(wanted, warm_start_impulse, c, w);
}

#endif
