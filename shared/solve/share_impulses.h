/* share_impulses.h - makes impulses of contacts whose bodies take many substeps those of one of these, or back those of
 * one of the few; see substep_classes.h. */
#ifndef TANDEM_SHARED_SOLVE_SHARE_IMPULSES_H
#define TANDEM_SHARED_SOLVE_SHARE_IMPULSES_H

#include "shared/friction_rows.h"
#include "shared/substep_classes.h"

SHARED mask is_contact_of_many(GLOBAL const uint *body_class, GLOBAL const uint *constraint_a,
                               GLOBAL const uint *constraint_b, item_index i)
{
  return is_of_many(larger_class(load_uint(body_class, load_uint(constraint_a, i)),
                                 load_uint(body_class, load_uint(constraint_b, i))));
}

SHARED void share_contact_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class,
                                        GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                        GLOBAL float4 *constraint_normal_impulse,
                                        GLOBAL float4 *constraint_friction_impulse, uint back, item_index i)
{
  mask of_many = is_contact_of_many(body_class, constraint_a, constraint_b, i);
  if (!any_of(of_many)) return;
  real share = impulse_share(parameters, back);
  vec4 normal = load_float4(constraint_normal_impulse, i);
  store_float4_if(of_many, constraint_normal_impulse, i,
                  make_vec4(share * normal.x, share * normal.y, share * normal.z, share * normal.w));
  if (!HAS_FEATURE(parameters, FRICTION)) return;
  vec4 friction = load_float4(constraint_friction_impulse, i);
  store_float4_if(of_many, constraint_friction_impulse, i,
                  make_vec4(share * friction.x, share * friction.y, share * friction.z, friction.w));
}

SHARED void share_rolling_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class,
                                        GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                        GLOBAL float4 *constraint_rolling, uint back, item_index i)
{
  mask of_many = is_contact_of_many(body_class, constraint_a, constraint_b, i);
  if (!any_of(of_many)) return;
  vec4 old = load_float4(constraint_rolling, i);
  store_float4_if(of_many, constraint_rolling, i, extend(scale(xyz(old), impulse_share(parameters, back)), old.w));
}

#endif
