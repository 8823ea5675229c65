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
  store_float4_if(of_many, constraint_normal_impulse, i, scale4(load_float4(constraint_normal_impulse, i), share));
  if (HAS_FEATURE(parameters, FRICTION)) share_row_if(of_many, constraint_friction_impulse, share, i);
}

SHARED void share_rolling_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class,
                                        GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                        GLOBAL float4 *constraint_rolling, uint back, item_index i)
{
  mask of_many = is_contact_of_many(body_class, constraint_a, constraint_b, i);
  if (any_of(of_many)) share_row_if(of_many, constraint_rolling, impulse_share(parameters, back), i);
}

#endif
