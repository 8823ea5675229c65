/* contact_friction.h - friction of a manifold: one cone and one twist at its centre, with masses as they are now.
 *
 * The masses are stored at the start of the step. Bodies that have turned since, or slid, may be lighter, a thin rod by
 * a thousand; an impulse for the stored mass would then turn them further than it should, and more each time.
 */
#ifndef TANDEM_SHARED_SOLVE_CONTACT_FRICTION_H
#define TANDEM_SHARED_SOLVE_CONTACT_FRICTION_H

#include "shared/solve/contact.h"

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

SHARED mask masses_are_stale(delta_pose moved, arm_shift shift, vec4 center_a, vec4 center_b)
{
  real turned = length_squared(moved.rotation_a) + length_squared(moved.rotation_b), limit = SAME_PLACE * SAME_PLACE;
  real slid = length_squared(shift.a) + length_squared(shift.b);
  return (turned > limit) | (slid > limit * (length_squared(xyz(center_a)) + length_squared(xyz(center_b))));
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

SHARED real spin_between(contact c) { return dot3(c.normal, subtract(c.velocity_b.angular, c.velocity_a.angular)); }
SHARED vec3 slide_between(contact c, vec3 arm_a, vec3 arm_b)
{
  return subtract(velocity_at(c.velocity_b, arm_b), velocity_at(c.velocity_a, arm_a));
}

SHARED real sum_of_points(vec4 normal_impulses)
{
  return (normal_impulses.x + normal_impulses.y) + (normal_impulses.z + normal_impulses.w);
}

/* The twist about the normal, and the cone of sliding friction at the centre of the manifold. spin, slide: the motion
 * of b relative to a that friction undoes; limit: of the impulse along the tangents. */
SHARED solved solve_twist(contact c, real spin, real mass, real limit, vec4 old)
{
  real twist_limit = limit * old.w;
  real twist = clamped(old.z - mass * spin, -twist_limit, twist_limit);
  solved s = {apply_turn(c, c.normal, c.normal, twist - old.z), make_vec4(old.x, old.y, twist, old.w)};
  return s;
}

SHARED solved solve_slide(contact c, mask stale, vec3 slide, vec3 arm_a, vec3 arm_b, real stored, real limit, vec4 old)
{
  tangents t = tangents_of(c.normal);
  real slide_first = dot3(slide, t.first), slide_second = dot3(slide, t.second);
  vec3 along = add(scale(t.first, slide_first), scale(t.second, slide_second));
  real mass = friction_mass_now(c, stale, stored, along, arm_a, arm_b);
  real first = old.x - mass * slide_first, second = old.y - mass * slide_second;
  real shrink = share_within_cone(first, second, limit);
  first = first * shrink;
  second = second * shrink;
  vec3 change = add(scale(t.first, first - old.x), scale(t.second, second - old.y));
  solved s = {apply_impulse(c, change, cross3(arm_a, change), cross3(arm_b, change), R(1.0)),
              make_vec4(first, second, old.z, old.w)};
  return s;
}

/* Both, against the present velocities. stale: whether the stored masses are stale. */
SHARED solved solve_friction(contact c, mask stale, arm_shift shift, vec4 center_a, vec4 center_b, vec4 impulse,
                             real normal_impulse_sum)
{
  real limit = c.friction * normal_impulse_sum;
  solved held = solve_twist(c, spin_between(c), twist_mass_now(c, stale, center_b.w), limit, impulse);
  vec3 arm_a = add(xyz(center_a), shift.a), arm_b = add(xyz(center_b), shift.b);
  return solve_slide(held.c, stale, slide_between(held.c, arm_a, arm_b), arm_a, arm_b, center_a.w, limit, held.impulse);
}

#endif
