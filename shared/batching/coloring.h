/* coloring.h - deterministic parallel graph colouring of the contacts.
 *
 * Contacts that share a moving body must not be solved at once. In each round, every uncoloured contact bids at its
 * moving bodies with a unique number. A contact with the highest bid at both takes the lowest colour that is free at
 * both (Jones and Plassmann, "A Parallel Graph Coloring Heuristic", 1993). Bids are a bijective hash of the pair's
 * index, so they never tie, and a maximum does not depend on order. The colouring is therefore the same on every
 * backend.
 *
 *      body      1 --- 2 --- 3         contacts are the edges of a graph of bodies; edges that meet at a body have
 *      colour      0     1             different colours
 */
#ifndef TANDEM_SHARED_BATCHING_COLORING_H
#define TANDEM_SHARED_BATCHING_COLORING_H

#include "shared/batching/match.h"

/* A bijection of 32-bit numbers (odd multipliers, xor-shifts). */
SHARED uint bid_of(uint pair)
{
  uint h = pair * 0x9e3779b1u;
  h ^= h >> 15;
  h *= 0x85ebca77u;
  h ^= h >> 13;
  return h;
}

SHARED uint is_moving(GLOBAL const uint *body_flags, uint body)
{
  return body_type_of(body_flags[body]) == (uint)BODY_TYPE_DYNAMIC;
}

/* The lowest colour not in the two masks; COLOR_OVERFLOW if all are taken. */
SHARED uint lowest_free_color(uint low_used, uint high_used)
{
  for (uint color = 0; color < COLOR_LIMIT; ++color) {
    uint word = color < 32u ? low_used : high_used;
    if ((word >> (color & 31u) & 1u) == 0u) return color;
  }
  return COLOR_OVERFLOW;
}

SHARED void take_color(GLOBAL uint *body_colors, uint body, uint color)
{
  body_colors[2u * body + (color >> 5)] |= 1u << (color & 31u);
}

SHARED uint free_color(GLOBAL const uint *body_colors, uint a, uint moving_a, uint b, uint moving_b)
{
  uint low = (moving_a ? body_colors[2u * a] : 0u) | (moving_b ? body_colors[2u * b] : 0u);
  uint high = (moving_a ? body_colors[2u * a + 1u] : 0u) | (moving_b ? body_colors[2u * b + 1u] : 0u);
  return lowest_free_color(low, high);
}

/* In a batch of worlds a pair bids with its index within its world, so that a world has the colours that it has alone.
 * Bids of two worlds may be equal, because they never meet at a body. */
SHARED uint bid_in_world(GLOBAL const Parameters *parameters, read_world_pairs pairs, uint i)
{
  return bid_of(HAS_FEATURE(parameters, WORLDS) ? i - pairs.start[pairs.world[2u * pairs.a[i]]] : i);
}

/* Even and odd rounds have separate bids, so that those of one can be cleared while those of the other are read. */
SHARED void place_bid(GLOBAL const uint *body_flags, GLOBAL uint *body_bid, uint a, uint b, uint bid, uint round)
{
  if (is_moving(body_flags, a)) ATOMIC_MAX(body_bid + 2u * a + (round & 1u), bid);
  if (is_moving(body_flags, b)) ATOMIC_MAX(body_bid + 2u * b + (round & 1u), bid);
}

/* A contact joins the overflow constraints at once if its bodies have all colours in use between them. If it waited for
 * a round, ten thousand contacts of one body would need ten thousand rounds, because one contact of a body wins
 * each. */
SHARED void color_bid_item(GLOBAL const Parameters *parameters, read_world_pairs pairs, read_nodes nodes,
                           GLOBAL const uint *body_colors, GLOBAL uint *counts, GLOBAL uint *pair_color,
                           GLOBAL uint *body_bid, uint round, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  uint a = node_of(parameters, nodes.link, pairs.a[i]), b = node_of(parameters, nodes.link, pairs.b[i]);
  GLOBAL const uint *body_flags = nodes.flags;
  if (free_color(body_colors, a, is_moving(body_flags, a), b, is_moving(body_flags, b)) != COLOR_OVERFLOW) {
    place_bid(body_flags, body_bid, a, b, bid_in_world(parameters, pairs, i), round);
    return;
  }
  pair_color[i] = COLOR_OVERFLOW;
  ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
  ATOMIC_MAX(counts + COUNT_ROUNDS, round + 1u);
}

/* True if the pair holds the highest bid of the round at each of its moving bodies; clears the bids of the next
 * round. */
SHARED uint wins_round(GLOBAL uint *body_bid, uint a, uint moving_a, uint b, uint moving_b, uint bid, uint round)
{
  uint now = round & 1u, next = now ^ 1u;
  if (moving_a) ATOMIC_MIN(body_bid + 2u * a + next, 0u);
  if (moving_b) ATOMIC_MIN(body_bid + 2u * b + next, 0u);
  return (!moving_a || body_bid[2u * a + now] == bid) && (!moving_b || body_bid[2u * b + now] == bid) ? 1u : 0u;
}

/* Only the winner of a body reads or writes the body's colours in this round. */
SHARED void assign_color(GLOBAL const uint *body_flags, GLOBAL uint *counts, GLOBAL uint *pair_color,
                         GLOBAL uint *body_colors, GLOBAL uint *body_bid, uint a, uint b, uint bid, uint round, uint i)
{
  uint moving_a = is_moving(body_flags, a), moving_b = is_moving(body_flags, b);
  if (!wins_round(body_bid, a, moving_a, b, moving_b, bid, round)) return;
  uint color = free_color(body_colors, a, moving_a, b, moving_b);
  pair_color[i] = color;
  if (moving_a) take_color(body_colors, a, color);
  if (moving_b) take_color(body_colors, b, color);
  ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
  ATOMIC_MAX(counts + COUNT_ROUNDS, round + 1u);
}

SHARED void color_assign_item(GLOBAL const Parameters *parameters, read_world_pairs pairs, read_nodes nodes,
                              GLOBAL uint *counts, GLOBAL uint *pair_color, GLOBAL uint *body_colors,
                              GLOBAL uint *body_bid, uint round, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  assign_color(nodes.flags, counts, pair_color, body_colors, body_bid, node_of(parameters, nodes.link, pairs.a[i]),
               node_of(parameters, nodes.link, pairs.b[i]), bid_in_world(parameters, pairs, i), round, i);
}

/* Whether no contact of the body has a later colour, whatever its joints have. */
SHARED uint is_last_color(GLOBAL const Parameters *parameters, GLOBAL const uint *body_colors,
                          GLOBAL const uint *body_joint_colors, uint body, uint color)
{
  uint low = body_colors[2u * body], high = body_colors[2u * body + 1u];
  if (HAS_FEATURE(parameters, JOINTS)) {
    low &= ~body_joint_colors[2u * body];
    high &= ~body_joint_colors[2u * body + 1u];
  }
  uint later = color < 32u ? (low >> color >> 1) | high : high >> (color - 32u) >> 1;
  return later == 0u ? 1u : 0u;
}

/* Colours are kept from step to step, and contacts that go leave gaps among them. A contact of one of the last colours
 * takes a lower one that is free at both bodies, because each colour takes a launch in every pass, however few contacts
 * it has. Only the last contact of both bodies does, so that no two of those that move meet at a body. */
SHARED void lower_colors_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_pair,
                              GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, read_nodes nodes,
                              GLOBAL const uint *pair_color, GLOBAL const uint *body_colors,
                              GLOBAL const uint *body_joint_colors, GLOBAL uint *cached_color, uint i)
{
  uint pair = constraint_pair[i], color = pair_color[pair];
  if (color >= COLOR_LIMIT) return;
  uint a = node_of(parameters, nodes.link, pair_a[pair]), b = node_of(parameters, nodes.link, pair_b[pair]);
  uint moving_a = is_moving(nodes.flags, a), moving_b = is_moving(nodes.flags, b);
  if (moving_a && !is_last_color(parameters, body_colors, body_joint_colors, a, color)) return;
  if (moving_b && !is_last_color(parameters, body_colors, body_joint_colors, b, color)) return;
  uint free = free_color(body_colors, a, moving_a, b, moving_b);
  if (free < color) cached_color[pair] = free;
}

/* The oracle: one item colours all contacts greedily in pair order. The sequential batching of the talks (GS-4150 slide
 * 42) fills batch after batch and takes each contact whose bodies are free; a contact comes into batch k if earlier
 * ones bar it from the batches before k, so "the lowest free colour, in order" gives the same batches in one pass. */
SHARED void color_in_order_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a,
                                GLOBAL const uint *pair_b, read_nodes nodes, GLOBAL uint *counts,
                                GLOBAL uint *pair_color, GLOBAL uint *body_colors, uint i)
{
  (void)i;
  for (uint pair = 0; pair < counts[COUNT_PAIRS]; ++pair) {
    if (pair_color[pair] != COLOR_NONE) continue;
    uint a = node_of(parameters, nodes.link, pair_a[pair]), b = node_of(parameters, nodes.link, pair_b[pair]);
    uint moving_a = is_moving(nodes.flags, a), moving_b = is_moving(nodes.flags, b);
    uint color = free_color(body_colors, a, moving_a, b, moving_b);
    pair_color[pair] = color;
    if (moving_a) take_color(body_colors, a, color);
    if (moving_b) take_color(body_colors, b, color);
  }
  counts[COUNT_UNCOLORED] = 0u;
}

#endif
