/* blow.h - wind that whirls about the origin drags every body along: v' = (v + r h w) / (1 + r h), stable at any r. */
#include "shared/records.h"

SHARED void blow_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *wind_whirl,
                      GLOBAL const float4 *body_position, GLOBAL float4 *solver_velocity, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  float4 whirl = wind_whirl[0];
  vec3 wind = cross3(make_vec3(whirl.x, whirl.y, whirl.z), load_position(body_position, i).high);
  real share = whirl.w * parameters->substep;
  m.linear = scale(add_scaled(m.linear, wind, share), R(1.0) / (R(1.0) + share));
  store_velocity_if(m.inverse_mass > R(0.0), solver_velocity, i, m);
}
