/* rolling.h - rolling and spinning friction from materials: coefficients, masses, and the torque of the last step.
 *
 * A contact of zero size gives no torque against rolling; real ones have a size, and their pressure moves ahead of
 * the centre. The material states by how much, in metres: the torque that resists is that length times the normal
 * force. See shared/solve/rolling.h. Only in scenes where a material has it.
 */
#ifndef TANDEM_SHARED_SETUP_ROLLING_H
#define TANDEM_SHARED_SETUP_ROLLING_H

#include "shared/setup/contact.h"

/* The torque impulse on b, a vector of the world, N m s; coefficients in m and the inverse moments' reciprocals in kg m^2
 * about axes in the tangent plane (the stiffest of them) and about the normal. */
typedef struct { real rolling, spinning, rolling_mass, spinning_mass; } rolling_resistance;

/* 1 / largest eigenvalue of the inverse inertia within the tangent plane, so that a disc can be projected as a circle. */
SHARED real rolling_mass(symmetric3 inertia_a, symmetric3 inertia_b, vec3 normal)
{
  tangents t = tangents_of(normal);
  vec3 first = add(symmetric_times(inertia_a, t.first), symmetric_times(inertia_b, t.first));
  vec3 second = add(symmetric_times(inertia_a, t.second), symmetric_times(inertia_b, t.second));
  real along_first = inner(t.first, first), along_second = inner(t.second, second), mixed = inner(t.second, first);
  real difference = along_first - along_second;
  return inverse_or_zero(R(0.5) * (along_first + along_second + square_root(difference * difference + R(4.0) * mixed * mixed)));
}

SHARED rolling_resistance resistance_between(GLOBAL const row *material, GLOBAL const row *material_rolling, natural a, natural b)
{
  natural rule_a = to_natural(load_row(material, a).w) & 7u, rule_b = to_natural(load_row(material, b).w) & 7u;
  vec4 of_a = load_row(material_rolling, a), of_b = load_row(material_rolling, b);
  rolling_resistance r = {combined(rule_a, rule_b, of_a.x, of_b.x), combined(rule_a, rule_b, of_a.y, of_b.y), R(0.0), R(0.0)};
  return r;
}

SHARED void prepare_rolling_item(GLOBAL const row *material, GLOBAL const row *material_rolling, GLOBAL const uint *body_traits,
                                 GLOBAL const row *solver_inertia, GLOBAL const uint *pair_cached, GLOBAL const row *cached_rolling_impulse,
                                 GLOBAL const uint *constraint_pair, GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                 GLOBAL const row *constraint_normal, GLOBAL const uint *counts, GLOBAL row *constraint_rolling,
                                 item_index i)
{
  natural a = load_natural(constraint_a, i), b = load_natural(constraint_b, i);
  vec3 normal = xyz(load_row(constraint_normal, i));
  symmetric3 inertia_a = load_inertia(solver_inertia, a), inertia_b = load_inertia(solver_inertia, b);
  rolling_resistance r = resistance_between(material, material_rolling, material_of(load_natural(body_traits, a)),
                                            material_of(load_natural(body_traits, b)));
  r.rolling_mass = rolling_mass(inertia_a, inertia_b, normal);
  r.spinning_mass = inverse_or_zero(inner(normal, add(symmetric_times(inertia_a, normal), symmetric_times(inertia_b, normal))));
  natural cached = load_natural(pair_cached, load_natural(constraint_pair, i));
  mask is_cached = cached != (natural)INDEX_NONE;
  vec3 kept = xyz(load_row(cached_rolling_impulse, choose(is_cached, cached, (natural)0u)));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_row(constraint_rolling, i, extend(choose3(is_cached, kept, none), R(0.0)));
  store_row(constraint_rolling, counts[CAPACITY_PAIRS] + i, make_vec4(r.rolling, r.spinning, r.rolling_mass, r.spinning_mass));
}

#endif
