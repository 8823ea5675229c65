/* note_moved.h - which bodies the step has moved: those whose pose differs from that before it in any bit that counts.
 *
 * It runs behind commit_bodies, when both sides of the state are at hand; a list is made of the flags by
 * parallel/compact.h. Only with Settings::moved_bodies.
 */
#ifndef TANDEM_SHARED_INTEGRATE_NOTE_MOVED_H
#define TANDEM_SHARED_INTEGRATE_NOTE_MOVED_H

#include "shared/records.h"

SHARED mask differs4(vec4 a, vec4 b) { return (a.x != b.x) | (a.y != b.y) | (a.z != b.z) | (a.w != b.w); }

SHARED void note_moved_item(GLOBAL const float4 *previous_body_position, GLOBAL const float4 *previous_body_orientation,
                            GLOBAL const float4 *body_position, GLOBAL const float4 *body_orientation,
                            GLOBAL uint *body_moved, item_index i)
{
  mask moved = differs4(load_float4(previous_body_position, i * 2u), load_float4(body_position, i * 2u)) |
               differs4(load_float4(previous_body_position, i * 2u + 1u), load_float4(body_position, i * 2u + 1u)) |
               differs4(load_float4(previous_body_orientation, i), load_float4(body_orientation, i));
  store_uint(body_moved, i, choose(moved, (uint_lanes)1u, (uint_lanes)0u));
}

#endif
