/* stop_at_time_of_impact.h - cuts a body's motion to the fraction that narrowphase/clamp_to_time_of_impact.h found free
 * of walls. */
#ifndef TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H
#define TANDEM_SHARED_INTEGRATE_STOP_AT_TIME_OF_IMPACT_H

#include "shared/records.h"
#include "shared/trigonometry.h"

/* body_toi_fraction: the fraction of the motion that is kept, in 1 / 2^24. */
SHARED void stop_at_time_of_impact_item(GLOBAL const float4 *body_orientation, GLOBAL const uint *body_toi_fraction,
                                        GLOBAL float4 *solver_delta_pose, GLOBAL float4 *solver_orientation,
                                        item_index i)
{
  real share = to_real(load_uint(body_toi_fraction, i)) * R(5.9604644775390625e-8);
  mask cut = share < R(1.0);
  if (!any_of(cut)) return;
  vec3 translation = scale(xyz(load_float4(solver_delta_pose, i * 2u)), share),
       rotation = scale(xyz(load_float4(solver_delta_pose, i * 2u + 1u)), share);
  store_float4_if(cut, solver_delta_pose, i * 2u, extend(translation, R(0.0)));
  store_float4_if(cut, solver_delta_pose, i * 2u + 1u, extend(rotation, R(0.0)));
  store_float4_if(cut, solver_orientation, i,
                  quat_to_vec4(turned(quat_from(load_float4(body_orientation, i)), rotation)));
}

#endif
