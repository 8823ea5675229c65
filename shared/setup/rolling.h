/* rolling.h - rolling and spinning friction from materials: coefficients, and the torque of the last step.
 *
 * A contact of zero size gives no torque against rolling; real ones have a size, and their pressure moves ahead of
 * the centre. The material states by how much, in metres: the torque that resists is that length times the normal
 * force. See shared/solve/rolling.h. Only in scenes where a material has it.
 */
#ifndef TANDEM_SHARED_SETUP_ROLLING_H
#define TANDEM_SHARED_SETUP_ROLLING_H

#include "shared/setup/contact.h"

/* Two lengths, in metres. */
typedef struct {
  real rolling, spinning;
} rolling_resistance;

SHARED rolling_resistance resistance_between(GLOBAL const row *material, GLOBAL const row *material_rolling, natural a,
                                             natural b)
{
  natural rule_a = to_natural(load_row(material, a).w) & 7u, rule_b = to_natural(load_row(material, b).w) & 7u;
  vec4 of_a = load_row(material_rolling, a), of_b = load_row(material_rolling, b);
  rolling_resistance r = {combined(rule_a, rule_b, of_a.x, of_b.x), combined(rule_a, rule_b, of_a.y, of_b.y)};
  return r;
}

SHARED void prepare_rolling_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf,
                                 GLOBAL const row *material, GLOBAL const row *material_rolling,
                                 GLOBAL const uint *body_traits, GLOBAL const uint *pair_cached,
                                 GLOBAL const row *cached_rolling_impulse, GLOBAL const uint *constraint_pair,
                                 read_contacts contacts, GLOBAL const uint *counts, GLOBAL row *constraint_rolling,
                                 item_index i)
{
  natural pair = load_natural(constraint_pair, i);
  natural a = shape_in_pair(parameters, pair_leaf, pair, 0u, load_natural(contacts.a, i));
  natural b = shape_in_pair(parameters, pair_leaf, pair, 1u, load_natural(contacts.b, i));
  rolling_resistance r = resistance_between(material, material_rolling, material_of(load_natural(body_traits, a)),
                                            material_of(load_natural(body_traits, b)));
  natural cached = load_natural(pair_cached, pair);
  mask is_cached = cached != (natural)INDEX_NONE;
  vec3 kept = xyz(load_row(cached_rolling_impulse, choose(is_cached, cached, (natural)0u)));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_row(constraint_rolling, i, extend(choose3(is_cached, kept, none), R(0.0)));
  store_row(constraint_rolling, counts[CAPACITY_PAIRS] + i, make_vec4(r.rolling, r.spinning, R(0.0), R(0.0)));
}

#endif
