/* nodes.h - the nodes of the graph of contacts: bodies, and articulations.
 *
 * An impulse on a link changes the velocities of all links of its articulation, so these are one node, for which the
 * body of the root stands.
 */
#ifndef TANDEM_SHARED_BATCHING_NODES_H
#define TANDEM_SHARED_BATCHING_NODES_H

#include "shared/batching/node_words.h"
#include "shared/records.h"

SHARED uint node_of(GLOBAL const Parameters *parameters, GLOBAL const uint *body_link, uint body)
{
  return HAS_FEATURE(parameters, ARTICULATIONS) ? body_link[LINK_WORDS * body] : body;
}

SHARED uint_lanes articulation_of_body(GLOBAL const uint *body_link, uint_lanes body)
{
  return load_uint(body_link, LINK_WORDS * body + 1u);
}
SHARED mask is_link(GLOBAL const uint *body_link, uint_lanes body)
{
  return articulation_of_body(body_link, body) != (uint_lanes)INDEX_NONE;
}

#endif
