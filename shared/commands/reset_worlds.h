/* reset_worlds.h - worlds of a batch that begin anew: their bodies are put where they started, and nothing is left of
 * their contacts.
 *
 * An item is a body of a world that is reset. Pairs in the cache are not removed, which would move those of all worlds
 * behind; they get a partner that no body is, so that no pair of the next step finds them, and the next step replaces
 * them all.
 */
#ifndef TANDEM_SHARED_COMMANDS_RESET_WORLDS_H
#define TANDEM_SHARED_COMMANDS_RESET_WORLDS_H

#include "shared/commands/apply_commands.h"

/* bodies: of each world. */
SHARED uint reset_body(GLOBAL const uint *reset_world, uint bodies, uint i)
{
  return reset_world[i / bodies] + i % bodies;
}

SHARED void reset_worlds_item(GLOBAL const uint *reset_world, GLOBAL const float4 *start_pose,
                              GLOBAL const float4 *start_velocity, GLOBAL const uint *cached_start,
                              GLOBAL float4 *body_position, GLOBAL float4 *body_orientation,
                              GLOBAL float4 *body_velocity, GLOBAL uint *cached_b, uint bodies, uint i)
{
  uint body = reset_body(reset_world, bodies, i);
  double_float3 position = {xyz(load_float4(start_pose, body * 3u)), xyz(load_float4(start_pose, body * 3u + 1u))};
  store_position(body_position, body, position);
  store_float4(body_orientation, body, load_float4(start_pose, body * 3u + 2u));
  store_linear_and_angular(body_velocity, body, xyz(load_float4(start_velocity, body * 2u)),
                           xyz(load_float4(start_velocity, body * 2u + 1u)));
  for (uint k = cached_start[body]; k < cached_start[body + 1u]; ++k) cached_b[k] = INDEX_NONE;
}

SHARED void reset_touching_item(GLOBAL const uint *reset_world, GLOBAL const uint *cached_start,
                                GLOBAL uint *cached_touching, uint bodies, uint i)
{
  uint body = reset_body(reset_world, bodies, i);
  for (uint k = cached_start[body]; k < cached_start[body + 1u]; ++k) cached_touching[k] = 0u;
}

/* rows: two of each body. */
SHARED void reset_forces_item(GLOBAL const uint *reset_world, GLOBAL float4 *rows, uint bodies, uint i)
{
  uint body = reset_body(reset_world, bodies, i);
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(rows, body * 2u, zero);
  store_float4(rows, body * 2u + 1u, zero);
}

#endif
