/* rolling.h - rolling and spinning friction from materials: coefficients, and the torque of the last step.
 *
 * A contact of zero size gives no torque against rolling. Real contacts have a size, and their pressure moves ahead of
 * the centre. The material states by how much, in metres; the torque that resists is that length times the normal force
 * (shared/solve/rolling.h). The kernel exists only in scenes whose materials have such friction.
 */
#ifndef TANDEM_SHARED_SETUP_ROLLING_H
#define TANDEM_SHARED_SETUP_ROLLING_H

#include "shared/setup/contact.h"

/* Two lengths, in metres. */
typedef struct {
  real rolling, spinning;
} rolling_resistance;

SHARED rolling_resistance resistance_between(GLOBAL const float4 *material, GLOBAL const float4 *material_rolling,
                                             uint_lanes a, uint_lanes b)
{
  uint_lanes rule_a = to_uint(load_float4(material, a).w) & 7u, rule_b = to_uint(load_float4(material, b).w) & 7u;
  vec4 of_a = load_float4(material_rolling, a), of_b = load_float4(material_rolling, b);
  rolling_resistance r = {combined(rule_a, rule_b, of_a.x, of_b.x), combined(rule_a, rule_b, of_a.y, of_b.y)};
  return r;
}

SHARED void prepare_rolling_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf,
                                 GLOBAL const float4 *material, GLOBAL const float4 *material_rolling,
                                 GLOBAL const uint *body_flags, GLOBAL const uint *pair_cached,
                                 GLOBAL const float4 *cached_rolling_impulse, GLOBAL const uint *constraint_pair,
                                 read_contacts contacts, GLOBAL const uint *counts, GLOBAL float4 *constraint_rolling,
                                 item_index i)
{
  uint_lanes pair = load_uint(constraint_pair, i);
  uint_lanes a = shape_in_pair(parameters, pair_leaf, pair, 0u, load_uint(contacts.a, i));
  uint_lanes b = shape_in_pair(parameters, pair_leaf, pair, 1u, load_uint(contacts.b, i));
  rolling_resistance r = resistance_between(material, material_rolling, material_of(load_uint(body_flags, a)),
                                            material_of(load_uint(body_flags, b)));
  uint_lanes cached = load_uint(pair_cached, pair);
  mask is_cached = cached != (uint_lanes)INDEX_NONE;
  vec3 kept = scale(xyz(load_float4(cached_rolling_impulse, choose(is_cached, cached, (uint_lanes)0u))),
                    parameters->warm_start_scale);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_float4(constraint_rolling, i, extend(choose3(is_cached, kept, none), R(0.0)));
  store_float4(constraint_rolling, counts[CAPACITY_PAIRS] + i, make_vec4(r.rolling, r.spinning, R(0.0), R(0.0)));
}

#endif
