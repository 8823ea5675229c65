/* contact_normals.h - the four normal rows of a manifold, solved together.
 *
 * Separations are updated from the motion since the step began:
 *
 *     s = s0 + n . (dx_b - dx_a) + (r_b x n) . dtheta_b - (r_a x n) . dtheta_a
 *
 * The bias treats penetration as an overdamped spring (Catto, "Soft Contact"), so pushing bodies apart adds no energy.
 */
#ifndef TANDEM_SHARED_SOLVE_CONTACT_NORMALS_H
#define TANDEM_SHARED_SOLVE_CONTACT_NORMALS_H

#include "shared/solve/contact.h"

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

#endif
