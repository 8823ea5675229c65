/* rest.h - for how many steps each body has been at rest, and what is known of that at the end of a step.
 *
 * A body rests while no point of it moves faster than a limit. The limit is sleep_speed for bodies of a metre and more,
 * and shrinks with smaller ones, because they are as small beside a millimetre as large ones are beside a metre. A body
 * that has rested for sleep_steps steps is drowsy: its island may fall asleep (islands.h).
 */
#ifndef TANDEM_SHARED_SLEEPING_REST_H
#define TANDEM_SHARED_SLEEPING_REST_H

#include "shared/records.h"

SHARED uint is_dynamic(GLOBAL const uint *body_flags, uint body)
{
  return body_type_of(body_flags[body]) == (uint)BODY_TYPE_DYNAMIC ? 1u : 0u;
}

/* The speed of the fastest point is at most that of the centre and that of the bounding sphere about it. */
SHARED mask is_at_rest(GLOBAL const Parameters *parameters, spatial_velocity m, real radius)
{
  real limit = parameters->sleep_speed * minimum(R(1.0), R(2.0) * radius);
  return length_of(m.linear) + radius * length_of(m.angular) <= limit;
}

/* A body whose support has just gone is not at rest, however slowly it still moves. body_falls alone does not say so,
 * because the gap of a contact that rests may be a hair beyond what it looks ahead. What falls has the velocity of one
 * step at least. */
SHARED mask falls_freely(GLOBAL const Parameters *parameters, GLOBAL const uint *body_falls,
                         GLOBAL const float4 *body_mass, vec3 velocity, uint body)
{
  real pull = load_float4(body_mass, body).w;
  real gained = R(0.5) * parameters->step * length_of(scale(gravity_of(parameters), pull));
  return body_falls[body] != 0u && gained > R(0.0) && length_of(velocity) > gained;
}

/* resting_steps: up to the last step. rest_count: with this one. */
SHARED void count_rest_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                            GLOBAL const float4 *body_shape, GLOBAL const float4 *body_mass,
                            GLOBAL const uint *body_falls, GLOBAL const float4 *solver_velocity,
                            GLOBAL const uint *resting_steps, GLOBAL uint *rest_count, GLOBAL uint *counts, uint i)
{
  uint limit = parameters->sleep_steps, steps = 0u;
  spatial_velocity m = load_velocity(solver_velocity, i);
  if (is_dynamic(body_flags, i) && is_at_rest(parameters, m, load_float4(body_shape, i).w) &&
      !falls_freely(parameters, body_falls, body_mass, m.linear, i))
    steps = resting_steps[i] < limit ? resting_steps[i] + 1u : limit;
  rest_count[i] = steps;
  if (steps == limit) ATOMIC_ADD(counts + COUNT_DROWSY, 1u);
}

/* What a program asks of a body begins its rest anew. */
SHARED void disturb_rest_item(GLOBAL const uint *command_start, GLOBAL const uint *command, GLOBAL uint *resting_steps,
                              uint i)
{
  resting_steps[command[2u * command_start[i]]] = 0u;
}

#endif
