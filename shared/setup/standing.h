/* standing.h - what stands on each body, and the rate of substeps that it needs.
 *
 * A soft contact under the load F sinks by F / effective mass / w^2, with w = 2 pi 0.2 / h at the stiffest that
 * substeps of h allow; and a stack of n layers buckles from n^3 = STIFFEST_STACK size / (g h^2) on. Both limit h
 * (docs/stability.md derives them). The load is the heaviest chain of bodies above, m1 + m2 + ..., but no more than
 * a contact of the last step has borne, because impacts are short and what leans on several bodies loads each with a
 * part. A chain passes on at most a few times what its contacts bore, because bodies that clasp one another would stand
 * on themselves.
 *
 *      [m3]           layers 0, weight 0
 *      [m2]           layers 1, weight m3
 *      [m1]           layers 2, weight m2 + m3, of all chains the heaviest
 *
 * Each pass carries layers and weights down by one body. They are maxima, so their order changes no bit.
 *
 * Where bodies rest on several others, statics alone does not say how much each bears. Passes over the contacts find it
 * as heat spreads, n layers in n^2 passes, and structures that find it too slowly sway for ever. They may sway by the
 * share of their size that small bodies have as slop. Heaps sway, too, but nobody built them: no more layers count than
 * stood at the start of the world.
 */
#ifndef TANDEM_SHARED_SETUP_STANDING_H
#define TANDEM_SHARED_SETUP_STANDING_H

#include "shared/load_rate.h"
#include "shared/setup/contact.h"
#include "shared/setup/order_codes.h"

/* (2 pi 0.2)^2: the square of the frequency of the stiffest contacts, times that of a substep. */
#define STIFFEST_CONTACT R(1.5791367)
/* Contacts may sink by so many times the slop under what they carry. */
#define BEARABLE_SINK R(2.0)
/* From about 35 cubes of 1 m on, a column buckles at 1/240 s and 10 m/s^2: 35^3 * 10 / 240^2. */
#define STIFFEST_STACK R(7.44)
/* Structures of n layers whose bodies rest on several others come to rest from this times n^2 substeps a second on:
 * about 11 levels of a tower of planks at 240, 16 at 480, 22 at 960. */
#define BRACED_REST R(2.0)
/* With fewer they sway by this times g h^2: towers of any size by about 3 cm at 1/240 s and 1 cm at 1/480 s. */
#define BRACED_SWAY R(200.0)
/* A contact stands if the square of the cosine between normal and gravity is at least this. */
#define STANDS R(0.5)

/* While a stack comes to rest, its contacts bear less than they will. */
#define PASSED_ON R(4.0)

typedef struct {
  uint_lanes lower, upper;
  real inverse_mass, inverse_mass_upper; /* 1/kg; the first of both together */
  real heavier;                          /* 1/kg, the smaller inverse mass that is not 0 */
  real up;                               /* the cosine, negative if b is above a */
  real closing;                          /* m/s */
} standing_pair;

/* normal: from a to b. */
SHARED standing_pair standing_pair_of(GLOBAL const Parameters *parameters, uint_lanes a, uint_lanes b,
                                      spatial_velocity of_a, spatial_velocity of_b, vec3 normal)
{
  real least = minimum(of_a.inverse_mass, of_b.inverse_mass), sum = of_a.inverse_mass + of_b.inverse_mass;
  standing_pair p;
  p.up = dot3(gravity_of(parameters), normal) / parameters->gravity_length;
  mask b_above = p.up < R(0.0);
  p.lower = choose(b_above, a, b);
  p.upper = choose(b_above, b, a);
  p.inverse_mass = sum;
  p.inverse_mass_upper = choose(b_above, of_b.inverse_mass, of_a.inverse_mass);
  p.heavier = choose(least > R(0.0), least, sum);
  p.closing = dot3(normal, subtract(of_a.linear, of_b.linear));
  return p;
}

SHARED standing_pair load_standing_pair(GLOBAL const Parameters *parameters, read_contacts contacts,
                                        GLOBAL const float4 *solver_velocity, item_index i)
{
  uint_lanes a = load_uint(contacts.a, i), b = load_uint(contacts.b, i);
  return standing_pair_of(parameters, a, b, load_velocity(solver_velocity, a), load_velocity(solver_velocity, b),
                          xyz(load_float4(contacts.normal, i)));
}

/* The force that the contact bore in the last step, N; 0 if it is new. impulse: its warm start. */
SHARED real force_borne(GLOBAL const Parameters *parameters, vec4 impulse)
{
  return ((impulse.x + impulse.y) + (impulse.z + impulse.w)) * parameters->inverse_substep;
}

/* Whether some point is as near as gravity closes within the step. */
SHARED mask stands_near(GLOBAL const Parameters *parameters, GLOBAL const memory_real *constraint_points,
                        point_planes planes, any_index i)
{
  real reach = R(0.5) * parameters->gravity_length * parameters->step * parameters->step;
  mask near = reach < R(0.0); /* none yet */
  for (uint k = 0; k < 4u; ++k) {
    mask used = load_point_mass(constraint_points, planes, k, i) > R(0.0),
         close = load_separation(constraint_points, planes, k, i) <= reach;
    near = near | (used & close);
  }
  return near;
}

/* Whether the contact bears its upper body, or is about to. */
SHARED mask stands(GLOBAL const Parameters *parameters, const standing_pair *p, real borne,
                   GLOBAL const memory_real *constraint_points, point_planes planes, any_index i)
{
  mask may_stand = (p->up * p->up >= STANDS) & (p->inverse_mass_upper > R(0.0));
  mask bears = may_stand & (borne > R(0.0));
  mask closes = may_stand & !bears & !(p->closing > parameters->gravity_length * parameters->step);
  if (any_of(closes)) bears = bears | (closes & stands_near(parameters, constraint_points, planes, i));
  return bears;
}

/* On how many contacts each body stands. supports: is 0 before. */
SHARED void count_supports_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *solver_velocity,
                                read_contacts contacts, GLOBAL const memory_real *constraint_points,
                                GLOBAL const float4 *constraint_normal_impulse, GLOBAL const uint *counts,
                                GLOBAL uint *body_supports, item_index i)
{
  if (!(parameters->gravity_length > R(0.0))) return;
  standing_pair p = load_standing_pair(parameters, contacts, solver_velocity, i);
  real borne = force_borne(parameters, load_float4(constraint_normal_impulse, i));
  atomic_add_if(stands(parameters, &p, borne, constraint_points, planes_of(counts), i), body_supports, p.upper, 1u);
}

/* The square of the rate of substeps at which so many layers of bodies that rest on several come to rest or sway by
 * `bearable`, 1/s^2. */
SHARED real rate_of_braced(GLOBAL const Parameters *parameters, uint_lanes layers, real bearable)
{
  real rests = BRACED_REST * to_real(layers) * to_real(layers);
  return minimum(rests * rests, BRACED_SWAY * parameters->gravity_length / bearable);
}

/* The square of the rate of substeps that the contact needs, 1/s^2. */
SHARED real rate_needed(GLOBAL const Parameters *parameters, const standing_pair *p, real load, uint_lanes layers,
                        real slop, real size)
{
  real sinks = load * p->inverse_mass / (STIFFEST_CONTACT * BEARABLE_SINK * slop);
  real tall = minimum(to_real(layers), load * p->heavier / parameters->gravity_length);
  real buckles = tall * tall * tall * parameters->gravity_length / (STIFFEST_STACK * R(2.0) * size);
  return maximum(sinks, buckles);
}

SHARED void note_braced(GLOBAL const Parameters *parameters, mask wanted, const standing_pair *p, uint_lanes layers,
                        uint layers_at_start, real bearable, GLOBAL uint *body_wish, GLOBAL uint *counts)
{
  uint_lanes at_start = layers_at_start, counted = choose(layers < at_start, layers, at_start);
  real rate = rate_of_braced(parameters, counted, bearable);
  mask noted = note_rate(parameters, wanted, rate, counts);
  note_wishes(parameters, noted, rate, body_wish, p->lower, p->upper);
  if (layers_at_start == INDEX_NONE && any_of(noted))
    atomic_max_if(noted, counts, (uint_lanes)(uint)COUNT_BRACED_LAYERS, layers);
}

/* The load on a contact that bears `borne`, N: of what stands on its upper body, which it passes on to the lower. */
SHARED real pass_on(GLOBAL const Parameters *parameters, mask wanted, const standing_pair *p, real borne,
                    uint_lanes layers, real above, GLOBAL uint *standing)
{
  real weight = R(1.0) / p->inverse_mass_upper + above;
  weight = choose(borne > R(0.0), minimum(weight, PASSED_ON * borne / parameters->gravity_length), weight);
  mask lower_moves = wanted & (p->inverse_mass > p->inverse_mass_upper); /* what cannot move bears everything */
  atomic_max_both_if(lower_moves, standing, p->lower * 2u, layers, real_bits(weight));
  return parameters->gravity_length * weight;
}

/* Whether a contact might need more than the fewest substeps. This is asked first, because it divides by nothing, and
 * its bounds leave more room than rounding takes. */
SHARED mask may_need_more(GLOBAL const Parameters *parameters, const standing_pair *p, real load, uint_lanes layers,
                          real slop, real size)
{
  real fewest = minimum(FEWEST_SUBSTEPS / parameters->step, SOFTEST_RATE), rate = R(0.99) * (fewest * fewest);
  real tall = to_real(layers);
  mask bears = load * p->inverse_mass <= rate * (STIFFEST_CONTACT * BEARABLE_SINK) * slop;
  mask is_straight = tall * tall * tall * parameters->gravity_length <= rate * (STIFFEST_STACK * R(2.0)) * size;
  return !(bears & is_straight);
}

/* What a contact that stands carries: the rate that it needs is noted, and what is above is passed on. standing_above:
 * of the pass before, or of the last step. standing: is 0 before. Returns the layers. */
SHARED uint_lanes weigh(GLOBAL const Parameters *parameters, const standing_pair *p, mask bears, mask is_new,
                        real borne, real size, GLOBAL const uint *standing_above, GLOBAL uint *standing,
                        GLOBAL uint *body_wish, GLOBAL uint *counts)
{
  uint_lanes layers = load_uint(standing_above, p->upper * 2u) + 1u;
  real above = real_of_bits(load_uint(standing_above, p->upper * 2u + 1u));
  real load = pass_on(parameters, bears, p, borne, layers, above, standing);
  load = choose(is_new, load, minimum(load, borne));
  real slop = bearable_way(parameters, size);
  real extent = choose(size > R(0.0), size, (real)R(0.5));
  if (any_of(bears & may_need_more(parameters, p, load, layers, slop, extent))) {
    real rate = rate_needed(parameters, p, load, layers, slop, extent);
    note_wishes(parameters, note_rate(parameters, bears, rate, counts), rate, body_wish, p->lower, p->upper);
  }
  return layers;
}

/* layers_at_start: COUNT_BRACED_LAYERS of the first step of the world, INDEX_NONE in that step. */
SHARED void weigh_standing_item(GLOBAL const Parameters *parameters, read_stacked_bodies stacked_bodies,
                                read_contacts contacts, read_loads_before loads_before,
                                GLOBAL const memory_real *constraint_points, GLOBAL const uint *standing_above,
                                GLOBAL uint *standing, GLOBAL uint *body_wish, GLOBAL uint *counts,
                                uint layers_at_start, item_index i)
{
  if (!(parameters->gravity_length > R(0.0))) return;
  standing_pair p = load_standing_pair(parameters, contacts, stacked_bodies.velocity, i);
  real borne = force_borne(parameters, load_float4(loads_before.normal_impulse, i));
  mask bears = stands(parameters, &p, borne, constraint_points, planes_of(counts), i);
  if (!any_of(bears)) return;
  mask is_new = load_uint(loads_before.cached, load_uint(loads_before.pair, i)) == (uint_lanes)INDEX_NONE;
  real size = size_between(stacked_bodies.shape, load_uint(contacts.a, i), load_uint(contacts.b, i));
  uint_lanes layers = weigh(parameters, &p, bears, is_new, borne, size, standing_above, standing, body_wish, counts);
  mask is_braced = bears & (load_uint(stacked_bodies.supports, p.upper) > (uint_lanes)1u);
  real extent = choose(size > R(0.0), size, (real)R(0.5));
  note_braced(parameters, is_braced, &p, layers, layers_at_start, bearable_share(parameters) * extent, body_wish,
              counts);
}

/* Set-up, and one pass of weigh_standing that needs no supports. Both read the same of a contact, and a step of four
 * substeps would otherwise read it twice. order: order_codes.h. */
SHARED void prepare_and_weigh_contacts_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *material,
                                            read_touching_bodies touching_bodies, read_part_pairs part_pairs,
                                            read_manifolds manifolds, read_cached_loads cached_loads,
                                            read_contact_orders contact_orders, GLOBAL uint *counts,
                                            write_constraints constraints, write_borne_bodies borne_bodies, uint order,
                                            item_index i)
{
  uint_lanes at = i, pair = i;
  if ((order & (uint)ORDER_BY_PAIR) != 0u) at = load_uint(contact_orders.constraint, i);
  else pair = load_uint(contact_orders.pair, i);
  if (!any_of(at != (uint_lanes)INDEX_NONE)) return;
  point_planes planes = planes_of(counts);
  read_cached_contacts cached_contacts = {cached_loads.of_pair, cached_loads.feature, cached_loads.single_impulse,
                                          cached_loads.normal_impulse, cached_loads.friction_impulse};
  points_setup points;
  contact_setup s = prepare_contact(parameters, material, touching_bodies, part_pairs, manifolds, cached_contacts,
                                    planes, constraints, borne_bodies.falls, &points, at, pair);
  if ((order & (uint)ORDER_WEIGHS) == 0u || !(parameters->gravity_length > R(0.0))) return;
  standing_pair p =
      standing_pair_of(parameters, s.bodies.a, s.bodies.b, s.bodies.velocity_a, s.bodies.velocity_b, s.normal);
  real borne =
      force_borne(parameters, make_vec4(points.impulse[0], points.impulse[1], points.impulse[2], points.impulse[3]));
  p.inverse_mass_upper = choose(s.wanted, p.inverse_mass_upper, (real)R(0.0)); /* then it does not stand */
  mask bears = stands(parameters, &p, borne, constraints.points, planes, choose(s.wanted, at, (uint_lanes)0u));
  if (!any_of(bears)) return;
  mask is_new = load_uint(cached_loads.of_pair, pair) == (uint_lanes)INDEX_NONE;
  weigh(parameters, &p, bears, is_new, borne, s.size, cached_loads.standing, borne_bodies.standing, borne_bodies.wish,
        counts);
}

#endif
