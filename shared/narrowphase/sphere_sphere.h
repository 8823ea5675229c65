/* sphere_sphere.h - the contact of two spheres, one point on the line between their centres.
 *
 * Within the step they first touch at the smaller root t of |offset + t velocity| = sum of the radii. They pass each
 * other where the velocity is perpendicular to the offset.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_SPHERE_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_SPHERE_H

#include "shared/narrowphase/pair_lists.h"
#include "shared/narrowphase/time_of_impact.h"

/* between: from the centre of a to the centre of b. fallback: the normal where the centres coincide. */
SHARED manifold spheres_contact(vec3 between, real radius_a, real radius_b, vec3 fallback)
{
  real distance = length_of(between);
  mask apart = distance > R(1e-12);
  vec3 normal = choose3(apart, scale(between, R(1.0) / choose(apart, distance, (real)R(1.0))), fallback);
  real separation = distance - radius_a - radius_b;
  return single_contact(normal, scale(normal, radius_a + separation * R(0.5)), separation, separation == separation);
}

/* The distance of the centres at their closest approach is computed from the vector itself. A difference of squares
 * would lose to rounding the small distance by which a fast pair misses. */
SHARED advancement impact_of_spheres(mask reached, vec3 between, real radii, pair_motion moves, toi_input input)
{
  vec3 velocity = subtract(moves.b.linear, moves.a.linear);
  real squared = length_squared(velocity);
  mask moving = reached & (squared > R(0.0));
  real inverse = R(1.0) / choose(moving, squared, (real)R(1.0)), nearest = -dot3(between, velocity) * inverse;
  real passing = length_of(add_scaled(between, velocity, nearest));
  real half_chord = square_root(maximum((radii - passing) * (radii + passing), R(0.0)) * inverse);
  advancement at = start_advancement(reached);
  at.active = reached & (!reached);
  real impact = maximum(nearest - half_chord, R(0.0));
  at.hits = moving & (nearest > R(0.0)) & (passing <= radii) & (impact < input.horizon);
  at.time = choose(at.hits, impact, clamped(nearest, R(0.0), input.horizon));
  return at;
}

/* Spheres that miss each other keep a contact at their closest approach, if they would run into the contact of the
 * start. The plane of that contact is parallel to their motion, so they never meet it, but it stops them if other
 * bodies push them into it. */
SHARED encounter encounter_of_spheres(GLOBAL const Parameters *parameters, speculation s, mask runs_into_start,
                                      advancement at, toi_input input)
{
  encounter met = encounter_of(parameters, s, at, input);
  mask passes = met.missed & runs_into_start;
  met.time = choose(passes, at.time, met.time);
  met.at_impact = met.at_impact | passes;
  met.missed = met.missed & (!passes);
  return met;
}

/* A margin for passing spheres, m: by how much a contact overestimates their approach. Gravity bends the path by a
 * quarter of its mean speed, and the setup stage places the arms without gravity. */
SHARED real margin_of_passing(GLOBAL const Parameters *parameters, pair_motion moves, real time)
{
  real unplaced = (length_of(moves.a.angular) + length_of(moves.b.angular)) * time;
  return (R(0.25) + unplaced) * length_of(moves.fall) * parameters->step;
}

SHARED void collide_sphere_sphere_item(read_listed_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                       read_bodies bodies, GLOBAL const Parameters *parameters,
                                       GLOBAL const uint *counts, write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, flags, PAIR_KIND_SPHERE_SPHERE, i);
  if (!any_of(item.mine)) return;
  uint_lanes a = item.a, b = item.b;
  mask mine = item.mine;

  real radius_a = load_float4(shapes, a).x, radius_b = load_float4(shapes, b).x, least = minimum(radius_a, radius_b);
  vec3 between = offset_between(bodies.position, a, b), aside = parting_direction(parameters, bodies.gravity, a, b);
  pair_motion moves = load_pair_motion(bodies, parameters, a, b, R(0.0), R(0.0));
  manifold m = spheres_contact(between, radius_a, radius_b, aside);
  m = kept_within(m, reach_of_pair(parameters, moves, m.normal));

  toi_input input = toi_input_of_step(parameters, moves, least, radius_a + radius_b);
  speculation s = speculation_of(parameters, m, between, moves, input, least);
  if (any_of(mine & s.asked)) {
    advancement at = impact_of_spheres(s.reached, between, radius_a + radius_b, moves, input);
    encounter met =
        encounter_of_spheres(parameters, s, approach_of_points(parameters, m, between, moves).reached[0], at, input);
    vec3 offset = offset_after(between, moves, choose(met.at_impact, met.time, (real)R(0.0)));
    manifold there = spheres_contact(offset, radius_a, radius_b, aside);
    there.point[0].w = there.point[0].w + choose(at.hits, (real)R(0.0), margin_of_passing(parameters, moves, met.time));
    m = choose_manifold(met.at_impact, there, m);
    m = as_seen_from_start(parameters, m, met, offset, moves);
  }
  store_manifold_if(mine, m, planes_of(counts), manifolds, item.pair);
}

#endif
