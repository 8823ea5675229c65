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

#include "shared/setup/contact.h"

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
/* The fewest substeps of a step, and the rate that contacts of 60 Hz, the softest, are the stiffest of. */
#define FEWEST_SUBSTEPS R(4.0)
#define SOFTEST_RATE R(300.0)
/* Above every rate that matters: what is beyond the range of floats needs the most substeps. */
#define HIGHEST_RATE R(1e30)
/* A world that allows no depth at all is judged by the depths that others allow. */
#define USUAL_SLOP R(0.005)
#define USUAL_SLOP_SHARE R(0.05)
/* A contact stands if the square of the cosine between normal and gravity is at least this. */
#define STANDS R(0.5)

/* While a stack comes to rest, its contacts bear less than they will. */
#define PASSED_ON R(4.0)

typedef struct {
  uint lower, upper;
  real inverse_mass, inverse_mass_upper; /* 1/kg; the first of both together */
  real heavier;                          /* 1/kg, the smaller inverse mass that is not 0 */
  real closing;                          /* m/s */
} standing_pair;

/* The cosine between gravity and the normal of the contact; 0 without gravity. */
SHARED real steepness(GLOBAL const Parameters *parameters, read_contacts contacts, uint i)
{
  if (!(parameters->gravity_length > R(0.0))) return R(0.0);
  vec3 normal = xyz(load_float4(contacts.normal, i));
  return dot3(gravity_of(parameters), normal) / parameters->gravity_length;
}

/* This is asked before bodies are read, which lie anywhere in memory. */
SHARED uint may_stand(real up) { return up * up >= STANDS ? 1u : 0u; }

SHARED standing_pair standing_pair_of(read_contacts contacts, GLOBAL const float4 *solver_velocity, real up, uint i)
{
  uint a = contacts.a[i], b = contacts.b[i];
  spatial_velocity of_a = load_velocity(solver_velocity, a), of_b = load_velocity(solver_velocity, b);
  vec3 normal = xyz(load_float4(contacts.normal, i));
  real least = minimum(of_a.inverse_mass, of_b.inverse_mass), sum = of_a.inverse_mass + of_b.inverse_mass;
  standing_pair p = {up < R(0.0) ? a : b,
                     up < R(0.0) ? b : a,
                     sum,
                     up < R(0.0) ? of_b.inverse_mass : of_a.inverse_mass,
                     least > R(0.0) ? least : sum,
                     dot3(normal, subtract(of_a.linear, of_b.linear))};
  return p;
}

/* The force that the contact bore in the last step, N; 0 if it is new. */
SHARED real force_borne(GLOBAL const Parameters *parameters, GLOBAL const float4 *constraint_normal_impulse, uint i)
{
  vec4 impulse = load_float4(constraint_normal_impulse, i);
  return ((impulse.x + impulse.y) + (impulse.z + impulse.w)) * parameters->inverse_substep;
}

/* Whether some point is as near as gravity closes within the step. */
SHARED uint stands_near(GLOBAL const Parameters *parameters, GLOBAL const memory_real *constraint_points,
                        point_planes planes, uint i)
{
  real reach = R(0.5) * parameters->gravity_length * parameters->step * parameters->step;
  for (uint k = 0; k < 4u; ++k)
    if (load_point_mass(constraint_points, planes, k, i) > R(0.0) &&
        load_separation(constraint_points, planes, k, i) <= reach)
      return 1u;
  return 0u;
}

/* Whether the contact, which may stand, bears its upper body, or is about to. */
SHARED uint stands(GLOBAL const Parameters *parameters, const standing_pair *p, real borne,
                   GLOBAL const memory_real *constraint_points, point_planes planes, uint i)
{
  if (!(p->inverse_mass_upper > R(0.0))) return 0u;
  if (borne > R(0.0)) return 1u;
  if (p->closing > parameters->gravity_length * parameters->step) return 0u;
  return stands_near(parameters, constraint_points, planes, i);
}

/* On how many contacts each body stands. supports: is 0 before. */
SHARED void count_supports_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *solver_velocity,
                                read_contacts contacts, GLOBAL const memory_real *constraint_points,
                                GLOBAL const float4 *constraint_normal_impulse, GLOBAL const uint *counts,
                                GLOBAL uint *body_supports, uint i)
{
  real up = steepness(parameters, contacts, i);
  if (!may_stand(up)) return;
  standing_pair p = standing_pair_of(contacts, solver_velocity, up, i);
  real borne = force_borne(parameters, constraint_normal_impulse, i);
  if (stands(parameters, &p, borne, constraint_points, planes_of(counts), i) != 0u)
    ATOMIC_ADD(body_supports + p.upper, 1u);
}

/* The square of the rate of substeps at which so many layers of bodies that rest on several come to rest or sway by
 * `bearable`, 1/s^2. */
SHARED real rate_of_braced(GLOBAL const Parameters *parameters, uint layers, real bearable)
{
  real rests = BRACED_REST * (real)layers * (real)layers;
  return minimum(rests * rests, BRACED_SWAY * parameters->gravity_length / bearable);
}

/* The square of the rate of substeps that the contact needs, 1/s^2. */
SHARED real rate_needed(GLOBAL const Parameters *parameters, const standing_pair *p, real load, uint layers, real slop,
                        real size)
{
  real sinks = load * p->inverse_mass / (STIFFEST_CONTACT * BEARABLE_SINK * slop);
  real tall = minimum((real)layers, load * p->heavier / parameters->gravity_length);
  real buckles = tall * tall * tall * parameters->gravity_length / (STIFFEST_STACK * R(2.0) * size);
  return maximum(sinks, buckles);
}

/* Rates that the fewest substeps have are not noted, so that few contacts meet at the maximum. */
SHARED uint note_rate(GLOBAL const Parameters *parameters, real rate, GLOBAL uint *counts)
{
  real fewest = minimum(FEWEST_SUBSTEPS / parameters->step, SOFTEST_RATE);
  if (!(rate > fewest * fewest)) return 0u;
  ATOMIC_MAX(counts + COUNT_LOAD_RATE, FLOAT_BITS(minimum(rate, HIGHEST_RATE)));
  return 1u;
}

SHARED void note_braced(GLOBAL const Parameters *parameters, uint layers, uint layers_at_start, real bearable,
                        GLOBAL uint *counts)
{
  uint counted = layers < layers_at_start ? layers : layers_at_start;
  uint noted = note_rate(parameters, rate_of_braced(parameters, counted, bearable), counts);
  if (layers_at_start == INDEX_NONE && noted != 0u) ATOMIC_MAX(counts + COUNT_BRACED_LAYERS, layers);
}

/* standing_above: of the pass before, or of the last step. standing: is 0 before. layers_at_start: COUNT_BRACED_LAYERS
 * of the first step of the world, INDEX_NONE in that step. Where it is 0, supports were not counted. */
SHARED void weigh_standing_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_shape,
                                GLOBAL const float4 *solver_velocity, read_contacts contacts,
                                read_loads_before loads_before, GLOBAL const memory_real *constraint_points,
                                GLOBAL const uint *body_supports, GLOBAL const uint *standing_above,
                                GLOBAL uint *standing, GLOBAL uint *counts, uint layers_at_start, uint i)
{
  real up = steepness(parameters, contacts, i);
  if (!may_stand(up)) return;
  standing_pair p = standing_pair_of(contacts, solver_velocity, up, i);
  real borne = force_borne(parameters, loads_before.normal_impulse, i);
  if (stands(parameters, &p, borne, constraint_points, planes_of(counts), i) == 0u) return;
  uint is_new = loads_before.cached[loads_before.pair[i]] == INDEX_NONE ? 1u : 0u;
  uint layers = standing_above[2u * p.upper] + 1u;
  real weight = R(1.0) / p.inverse_mass_upper + BITS_FLOAT(standing_above[2u * p.upper + 1u]);
  if (borne > R(0.0)) weight = minimum(weight, PASSED_ON * borne / parameters->gravity_length);
  if (p.inverse_mass > p.inverse_mass_upper) { /* what cannot move bears everything */
    ATOMIC_MAX(standing + 2u * p.lower, layers);
    ATOMIC_MAX(standing + 2u * p.lower + 1u, FLOAT_BITS(weight));
  }
  real load = parameters->gravity_length * weight;
  if (!is_new) load = minimum(load, borne);
  real size = size_between(body_shape, contacts.a[i], contacts.b[i]);
  real slop = parameters->slop > R(0.0) ? parameters->slop : USUAL_SLOP;
  real share = parameters->slop_share > R(0.0) ? parameters->slop_share : USUAL_SLOP_SHARE;
  if (size > R(0.0)) slop = minimum(slop, share * size);
  else size = R(0.5);
  note_rate(parameters, rate_needed(parameters, &p, load, layers, slop, size), counts);
  if (layers_at_start != 0u && body_supports[p.upper] > 1u)
    note_braced(parameters, layers, layers_at_start, share * size, counts);
}

#endif
