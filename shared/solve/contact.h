/* contact.h - the soft-step contact solver: projected Gauss-Seidel over one colour at a time.
 *
 * Each substep: warm start, solve with soft bias, move bodies, solve again without bias (relax). The bias
 * treats penetration as an overdamped spring, so pushing bodies apart adds no energy; relaxing takes the
 * bias velocity out again. Separations are updated from the motion since the step began:
 *
 *     s = s0 + n . (dx_b - dx_a) + (r_b x n) . dtheta_b - (r_a x n) . dtheta_a
 *
 * After Catto, "Soft Contact" and "Substepping" (Box2D version 3, Solver2D, 2024); Macklin et al., "Small
 * Steps in Physics Simulation", 2019. Constraints of one colour share no moving body.
 */
#ifndef TANDEM_SHARED_SOLVE_CONTACT_H
#define TANDEM_SHARED_SOLVE_CONTACT_H

#include "shared/friction_rows.h"
#include "shared/setup/contact.h"
#include "shared/solve/pass.h"

typedef struct {
  uint_lanes a, b;
  spatial_velocity velocity_a, velocity_b;
  symmetric3 inertia_a, inertia_b;
  vec3 normal;
  real friction;
  real follows; /* 1: arms follow what the bodies slide past each other; 0: they stay as they are, of bodies that pass
                   each other fast */
  real locks_a, locks_b; /* linear, as in solver_inertia */
} contact;

SHARED contact load_contact(GLOBAL const Parameters *parameters, read_contacts contacts,
                            GLOBAL const float4 *solver_velocity, GLOBAL const float4 *solver_inertia, any_index i)
{
  contact c;
  c.a = load_uint(contacts.a, i);
  c.b = load_uint(contacts.b, i);
  c.velocity_a = load_velocity(solver_velocity, c.a);
  c.velocity_b = load_velocity(solver_velocity, c.b);
  c.inertia_a = load_inertia_and_locks(parameters, solver_inertia, c.a, c.velocity_a, &c.locks_a);
  c.inertia_b = load_inertia_and_locks(parameters, solver_inertia, c.b, c.velocity_b, &c.locks_b);
  vec4 normal = load_float4(contacts.normal, i);
  c.normal = xyz(normal);
  c.friction = friction_of(normal.w);
  c.follows = choose(normal.w < R(0.0), (real)R(0.0), (real)R(1.0));
  return c;
}

/* Bodies that cannot move are never written, because constraints of one colour share them. */
SHARED void store_contact_velocities_if(mask wanted, GLOBAL float4 *solver_velocity, contact c)
{
  store_velocity_if(wanted & (c.velocity_a.inverse_mass > R(0.0)), solver_velocity, c.a, c.velocity_a);
  store_velocity_if(wanted & (c.velocity_b.inverse_mass > R(0.0)), solver_velocity, c.b, c.velocity_b);
}
SHARED void store_contact_velocities(GLOBAL float4 *solver_velocity, contact c)
{
  store_velocity_if(c.velocity_a.inverse_mass > R(0.0), solver_velocity, c.a, c.velocity_a);
  store_velocity_if(c.velocity_b.inverse_mass > R(0.0), solver_velocity, c.b, c.velocity_b);
}

/* An impulse of 0 is not applied, because adding 0 would turn -0 into +0, and the bits would depend on what shares the
 * lanes. */
SHARED contact with_velocities_if(mask wanted, contact c, contact moved)
{
  c.velocity_a.linear = choose3(wanted, moved.velocity_a.linear, c.velocity_a.linear);
  c.velocity_a.angular = choose3(wanted, moved.velocity_a.angular, c.velocity_a.angular);
  c.velocity_b.linear = choose3(wanted, moved.velocity_b.linear, c.velocity_b.linear);
  c.velocity_b.angular = choose3(wanted, moved.velocity_b.angular, c.velocity_b.angular);
  return c;
}

SHARED contact apply_turn(contact c, vec3 r_cross_n_a, vec3 r_cross_n_b, real impulse)
{
  c.velocity_a.angular = add_scaled(c.velocity_a.angular, symmetric_times(c.inertia_a, r_cross_n_a), -impulse);
  c.velocity_b.angular = add_scaled(c.velocity_b.angular, symmetric_times(c.inertia_b, r_cross_n_b), impulse);
  return c;
}

/* Impulse along a direction through arms whose cross products with it are r_cross_n_a, r_cross_n_b. */
SHARED contact apply_impulse(contact c, vec3 direction, vec3 r_cross_n_a, vec3 r_cross_n_b, real impulse)
{
  c.velocity_a.linear = pushed(c.velocity_a.linear, c.locks_a, direction, -(c.velocity_a.inverse_mass * impulse));
  c.velocity_b.linear = pushed(c.velocity_b.linear, c.locks_b, direction, c.velocity_b.inverse_mass * impulse);
  return apply_turn(c, r_cross_n_a, r_cross_n_b, impulse);
}

SHARED real speed_along(contact c, vec3 direction, vec3 r_cross_n_a, vec3 r_cross_n_b)
{
  return dot3(direction, subtract(c.velocity_b.linear, c.velocity_a.linear)) + dot3(r_cross_n_b, c.velocity_b.angular) -
         dot3(r_cross_n_a, c.velocity_a.angular);
}

/* The motion of the bodies since the step began. */
typedef struct {
  vec3 translation, rotation_a, rotation_b;
} delta_pose;

SHARED delta_pose load_delta_pose(GLOBAL const float4 *solver_delta_pose, contact c)
{
  delta_pose d = {
      subtract(xyz(load_float4(solver_delta_pose, c.b * 2u)), xyz(load_float4(solver_delta_pose, c.a * 2u))),
      xyz(load_float4(solver_delta_pose, c.a * 2u + 1u)), xyz(load_float4(solver_delta_pose, c.b * 2u + 1u))};
  return d;
}

SHARED arm_shift shift_of_contact(contact c, vec3 slid)
{
  return shift_of_arms(c.velocity_a, c.velocity_b, scale(slid, c.follows));
}

SHARED arm_shift load_arm_shift(GLOBAL const float4 *solver_delta_pose, contact c)
{
  return shift_of_contact(
      c, subtract(xyz(load_float4(solver_delta_pose, c.b * 2u)), xyz(load_float4(solver_delta_pose, c.a * 2u))));
}

/* The normal rows of the four points of a manifold: angular Jacobians, masses and impulses. */
typedef struct {
  vec3 r_cross_n_a[4], r_cross_n_b[4];
  real mass[4], impulse[4];
} normal_rows;

/* Loads the Jacobians, masses and impulses of the points. The caller keeps their separations at the start of the step.
 * offset: of constraint_offset. */
SHARED normal_rows load_normal_rows(GLOBAL const memory_real *constraint_points, point_planes planes, contact c,
                                    vec4 offset, arm_shift shift, vec4 impulses, item_index i)
{
  normal_rows s;
  for (uint k = 0; k < 4u; ++k) {
    vec3 arm_a = load_arm_of_a(constraint_points, planes, k, i), arm_b = subtract(arm_a, xyz(offset));
    s.r_cross_n_a[k] = cross3(add(arm_a, shift.a), c.normal);
    s.r_cross_n_b[k] = cross3(add(arm_b, shift.b), c.normal);
    s.mass[k] = load_point_mass(constraint_points, planes, k, i);
    s.impulse[k] = component(impulses, (uint_lanes)k);
  }
  return s;
}

/* The arm of b to the centre of the friction patch, and the effective mass of twisting. center_a: the arm of a. */
SHARED vec4 center_of_b(vec4 center_a, vec4 offset) { return extend(subtract(xyz(center_a), xyz(offset)), offset.w); }

/* The sum of a manifold's impulses: one linear impulse, and the angular impulses on the two bodies. */
typedef struct {
  vec3 impulse, angular_impulse_a, angular_impulse_b;
} wrench;

/* friction: along the two tangents at the centre, and about the normal. */
SHARED wrench wrench_of(contact c, normal_rows s, vec3 center_a, vec3 center_b, vec4 friction)
{
  tangents t = tangents_of(c.normal);
  vec3 slide = add(scale(t.first, friction.x), scale(t.second, friction.y));
  wrench w = {slide, add(cross3(center_a, slide), scale(c.normal, friction.z)),
              add(cross3(center_b, slide), scale(c.normal, friction.z))};
  for (uint k = 0; k < 4u; ++k) {
    w.impulse = add_scaled(w.impulse, c.normal, s.impulse[k]);
    w.angular_impulse_a = add_scaled(w.angular_impulse_a, s.r_cross_n_a[k], s.impulse[k]);
    w.angular_impulse_b = add_scaled(w.angular_impulse_b, s.r_cross_n_b[k], s.impulse[k]);
  }
  return w;
}

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

typedef struct {
  contact c;
  vec4 impulse;
} solved;

/* The masses of the start of the step still hold for bodies that have turned by less than this, in radians, and slid by
 * less than this share of their arms. For a thin rod this is a large motion: its axis has left the arm of its end by a
 * part of its thickness. */
#define SAME_PLACE R(0.02)
/* A mobility higher than that of the stored mass by this factor does not make an iteration diverge. */
#define SAME_MOBILITY R(1.05)
/* A mobility that differs from that of the stored mass by more than this factor is that of a body that lies otherwise,
 * and not of arms that have followed a slide. */
#define OTHER_MOBILITY R(2.0)

SHARED mask masses_are_stale(delta_pose moved, arm_shift shift, vec4 center_a, vec4 center_b)
{
  real turned = length_squared(moved.rotation_a) + length_squared(moved.rotation_b), limit = SAME_PLACE * SAME_PLACE;
  real slid = length_squared(shift.a) + length_squared(shift.b);
  return (turned > limit) | (slid > limit * (length_squared(xyz(center_a)) + length_squared(xyz(center_b))));
}

/* The bodies of a contact in the form that setup uses. The offset is not valid, because no mass depends on it. */
SHARED body_pair bodies_of(contact c)
{
  body_pair bodies = {c.a, c.b, c.velocity_a, c.velocity_b, c.inertia_a, c.inertia_b, c.normal, c.locks_a, c.locks_b};
  return bodies;
}

/* The friction mass at the current poses. A body that has turned, or whose arms have followed it, would get more
 * turning than sliding from an impulse for the stored mass, and more each time; it gets the mass along its slide
 * instead. slide: along the tangents. */
SHARED real friction_mass_now(contact c, mask stale, real stored, vec3 slide, vec3 arm_a, vec3 arm_b)
{
  if (!any_of(stale)) return stored;
  real squared = length_squared(slide), mobility = response(bodies_of(c), arm_a, arm_b, slide, slide);
  mask diverges = stale & (stored * mobility > SAME_MOBILITY * squared);
  return choose(diverges, squared / choose(diverges, mobility, (real)R(1.0)), stored);
}

/* The mass of twisting at the current poses, in the same way. Without uneven bodies it is the stored one. */
SHARED real twist_mass_now(contact c, mask stale, real stored)
{
  if (!MAY_OCCUR(GYROSCOPIC) || !any_of(stale)) return stored;
  return choose(stale, minimum(stored, twist_mass(bodies_of(c), c.normal)), stored);
}

/* The share of an impulse of sliding friction that does not leave the cone. */
SHARED real share_within_cone(real first, real second, real limit)
{
  real squared = first * first + second * second;
  mask slips = squared > limit * limit;
  return choose(slips, limit / square_root(choose(slips, squared, (real)R(1.0))), (real)R(1.0));
}

/* Solves the twist about the normal and the cone of sliding friction at the centre of the manifold. stale: whether the
 * stored masses are stale. */
SHARED solved solve_friction(contact c, mask stale, arm_shift shift, vec4 center_a, vec4 center_b, vec4 impulse,
                             real normal_impulse_sum)
{
  real limit = c.friction * normal_impulse_sum;
  real spin = dot3(c.normal, subtract(c.velocity_b.angular, c.velocity_a.angular));
  real twist_limit = limit * impulse.w;
  real twist = clamped(impulse.z - twist_mass_now(c, stale, center_b.w) * spin, -twist_limit, twist_limit);
  c = apply_turn(c, c.normal, c.normal, twist - impulse.z);

  tangents t = tangents_of(c.normal);
  vec3 arm_a = add(xyz(center_a), shift.a), arm_b = add(xyz(center_b), shift.b);
  vec3 slide = subtract(velocity_at(c.velocity_b, arm_b), velocity_at(c.velocity_a, arm_a));
  real slide_first = dot3(slide, t.first), slide_second = dot3(slide, t.second);
  vec3 along = add(scale(t.first, slide_first), scale(t.second, slide_second));
  real mass = friction_mass_now(c, stale, center_a.w, along, arm_a, arm_b);
  real first = impulse.x - mass * slide_first, second = impulse.y - mass * slide_second;
  real shrink = share_within_cone(first, second, limit);
  first = first * shrink;
  second = second * shrink;
  vec3 change = add(scale(t.first, first - impulse.x), scale(t.second, second - impulse.y));
  solved s = {apply_impulse(c, change, cross3(arm_a, change), cross3(arm_b, change), R(1.0)),
              {first, second, twist, impulse.w}};
  return s;
}

typedef struct {
  real rate, mass_scale, impulse_scale;
} softness;

SHARED softness softness_against(GLOBAL const Parameters *parameters, mask against_fixed)
{
  softness s = {choose(against_fixed, (real)parameters->static_bias_rate, (real)parameters->bias_rate),
                choose(against_fixed, (real)parameters->static_mass_scale, (real)parameters->mass_scale),
                choose(against_fixed, (real)parameters->static_impulse_scale, (real)parameters->impulse_scale)};
  return s;
}
SHARED softness softness_of(GLOBAL const Parameters *parameters, contact c)
{
  return softness_against(parameters, (c.velocity_a.inverse_mass == R(0.0)) | (c.velocity_b.inverse_mass == R(0.0)));
}

/* Returns the new accumulated impulse of one normal row. Ahead of contact the bodies may close the gap and no more. In
 * penetration the bias pushes them apart, unless the pass relaxes. A relaxing pass leaves a point that is still ahead
 * and has carried nothing as it is, because the motion that the point would limit comes later. The impulse may pull;
 * block_solve_normals cuts that off. */
SHARED real normal_impulse(GLOBAL const Parameters *parameters, softness soft, real slop_or_deep, real separation,
                           real speed, real mass, real old, uint biased)
{
  mask ahead = separation > R(0.0);
  real push =
      maximum(soft.rate * minimum(separation + slop_of(slop_or_deep), R(0.0)), -push_limit(parameters, slop_or_deep));
  mask rigid = ahead | (push == R(0.0));
  real bias = choose(ahead, separation * parameters->inverse_substep, biased != 0u ? push : (real)R(0.0));
  real mass_scale = biased != 0u ? choose(rigid, (real)R(1.0), soft.mass_scale) : (real)R(1.0);
  real impulse_scale = biased != 0u ? choose(rigid, (real)R(0.0), soft.impulse_scale) : (real)R(0.0);
  real impulse = old - mass * mass_scale * (speed + bias) - impulse_scale * old;
  return biased != 0u ? impulse : choose(ahead & (old == R(0.0)), old, impulse);
}

/* Twice the energy that an impulse along the normal gives to linear motion. */
SHARED real linear_energy(contact c, real impulse)
{
  real energy = (c.velocity_a.inverse_mass + c.velocity_b.inverse_mass) * impulse * impulse;
  mask locked = (c.locks_a + c.locks_b) > R(0.0);
  if (!MAY_OCCUR(LOCKS) || !any_of(locked)) return energy;
  return choose(locked, linear_response(bodies_of(c), c.normal, c.normal) * impulse * impulse, energy);
}

/* Moves all points towards their target impulses at once, so that a box on four corners does not tilt towards the
 * corner that is solved first. Target impulses that pull are cut to 0. The changes of all points are one direction. The
 * share of this direction that brings the points nearest to their targets together is own / whole: the energy that the
 * uncut targets would do along it with the points apart, over the energy of the direction with the points coupled. */
SHARED contact block_solve_normals(contact c, normal_rows *s, const real *target_impulse)
{
  real change[4], sum = R(0.0), own = R(0.0);
  vec3 r_cross_n_a = make_vec3(R(0.0), R(0.0), R(0.0)), r_cross_n_b = r_cross_n_a;
  for (uint k = 0; k < 4u; ++k) {
    mask used = s->mass[k] > R(0.0);
    change[k] = choose(used, maximum(target_impulse[k], R(0.0)) - s->impulse[k], (real)R(0.0));
    sum = sum + change[k];
    own = own + change[k] * (target_impulse[k] - s->impulse[k]) / choose(used, s->mass[k], (real)R(1.0));
    r_cross_n_a = add_scaled(r_cross_n_a, s->r_cross_n_a[k], change[k]);
    r_cross_n_b = add_scaled(r_cross_n_b, s->r_cross_n_b[k], change[k]);
  }
  real whole = linear_energy(c, sum) + dot3(r_cross_n_a, symmetric_times(c.inertia_a, r_cross_n_a)) +
               dot3(r_cross_n_b, symmetric_times(c.inertia_b, r_cross_n_b));
  real share = minimum(own / choose(whole > R(0.0), whole, (real)R(1.0)), R(2.0));
  mask pulls = s->impulse[0] + share * change[0] < R(0.0);
  for (uint k = 1; k < 4u; ++k) pulls = pulls | (s->impulse[k] + share * change[k] < R(0.0));
  share = choose(pulls, minimum(share, R(1.0)), share);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = s->impulse[k] + share * change[k];
  c.velocity_a.linear = pushed(c.velocity_a.linear, c.locks_a, c.normal, -(c.velocity_a.inverse_mass * (share * sum)));
  c.velocity_b.linear = pushed(c.velocity_b.linear, c.locks_b, c.normal, c.velocity_b.inverse_mass * (share * sum));
  return apply_turn(c, r_cross_n_a, r_cross_n_b, share);
}

/* Makes one pass over the points, where they are after the bodies have moved. */
SHARED contact solve_normals(GLOBAL const Parameters *parameters, contact c, normal_rows *s, delta_pose moved,
                             GLOBAL const memory_real *constraint_points, point_planes planes, real slop, uint biased,
                             item_index i)
{
  softness soft = softness_of(parameters, c);
  real closed = dot3(c.normal, moved.translation), target_impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    real separation = load_separation(constraint_points, planes, k, i) + closed +
                      (dot3(s->r_cross_n_b[k], moved.rotation_b) - dot3(s->r_cross_n_a[k], moved.rotation_a));
    real speed = speed_along(c, c.normal, s->r_cross_n_a[k], s->r_cross_n_b[k]);
    target_impulse[k] = normal_impulse(parameters, soft, slop, separation, speed, s->mass[k], s->impulse[k], biased);
  }
  return block_solve_normals(c, s, target_impulse);
}

SHARED vec4 impulses_of(const normal_rows *s)
{
  return make_vec4(s->impulse[0], s->impulse[1], s->impulse[2], s->impulse[3]);
}

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

/* Further passes over the points of an impact. The points are coupled, and a single pass would leave a fast body
 * moving; these bring all points to rest. */
#define IMPACT_ROUNDS 15u

/* Applies changed impulses of a manifold's rows together, so that momentum is rounded once. */
SHARED contact apply_changes(contact c, const normal_rows *s, vec4 changes)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), r_cross_n_a = none, r_cross_n_b = none;
  for (uint k = 0; k < 4u; ++k) {
    real change = component(changes, (uint_lanes)k);
    r_cross_n_a = add_scaled(r_cross_n_a, s->r_cross_n_a[k], change);
    r_cross_n_b = add_scaled(r_cross_n_b, s->r_cross_n_b[k], change);
  }
  real sum = (changes.x + changes.y) + (changes.z + changes.w);
  c.velocity_a.linear = pushed(c.velocity_a.linear, c.locks_a, c.normal, -(c.velocity_a.inverse_mass * sum));
  c.velocity_b.linear = pushed(c.velocity_b.linear, c.locks_b, c.normal, c.velocity_b.inverse_mass * sum);
  return apply_turn(c, r_cross_n_a, r_cross_n_b, R(1.0));
}

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
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_float4_if(at_impact, contact_impulses.restitution, planes.stride + i,
                    highest_impulses(load_float4(contact_impulses.restitution, planes.stride + i), normal_impulses));
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
    real normal_impulse_sum = (impulses.x + impulses.y) + (impulses.z + impulses.w);
    mask stale = masses_are_stale(moved, shift, center_a, center_b);
    solved sliding = solve_friction(c, stale, shift, center_a, center_b, friction, normal_impulse_sum);
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
      real target = component(target_velocity, (uint_lanes)k);
      mask applies = (target >= R(0.0)) & (component(highest, (uint_lanes)k) > R(0.0));
      real wanted = s.impulse[k] - s.mass[k] * (speed_along(c, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k]) - target);
      normal_impulses[k] = choose(applies, wanted, s.impulse[k]);
    }
    c = block_solve_normals(c, &s, normal_impulses);
  }
  store_float4_if(bounces, constraint_normal_impulse, i,
                  make_vec4(s.impulse[0], s.impulse[1], s.impulse[2], s.impulse[3]));
  store_contact_velocities(solver_velocity, with_velocities_if(bounces, before, c));
}

#endif
