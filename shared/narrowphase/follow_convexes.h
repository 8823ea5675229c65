/* follow_convexes.h - pairs of convex shapes that may pass each other within the step are followed to where they meet.
 *
 *   collide_convex or reduce_contacts -> follow_convexes: contacts of the impact, those of the start, or none
 *
 * A kernel of its own: few pairs are followed, and in one kernel with the manifolds of all a device would wait for the slowest of
 * them, with the registers of both. The bodies are advanced as conservative_advancement.h says.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOW_CONVEXES_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOW_CONVEXES_H

#include "shared/narrowphase/collide_convex.h"

/* Shapes without a contact at the start are followed only because one of them is a triangle. */
SHARED speculation speculation_of_query(GLOBAL const Parameters *parameters, const convex_query *query, manifold start, journey way)
{
  speculation s = speculation_of(parameters, start, query->moves, way, least_of_query(query));
  if (!has_points(start)) s.asked = s.reached = 1;
  return s;
}

/* The manifold of the whole step. */
SHARED manifold contact_over_step(GLOBAL const Parameters *parameters, convex_query *query, manifold start, uint method)
{
  journey way = journey_of_query(parameters, query);
  speculation s = speculation_of_query(parameters, query, start, way);
  way.far = way.far || !has_points(start);
  encounter met = meet(parameters, &query->first, &query->second, query->offset, query->moves, way, s);
  if (!met.at_impact && !met.missed) return start;
  manifold m = start;
  if (met.at_impact) m = contact_of_query(parameters, query, method);
  if (met.at_impact && !has_points(m)) { /* a triangle leaves it to its neighbour */
    met.at_impact = 0;
    met.missed = 1;
    m = start;
  }
  vec3 offset = offset_after(query->offset, query->moves, met.at_impact ? met.time : R(0.0));
  return as_seen_from_start(parameters, m, met, offset, query->moves);
}

SHARED void follow_convexes_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits, GLOBAL const row *shapes,
                                 GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const uint *headers, GLOBAL const row *vertices,
                                 GLOBAL const row *planes, GLOBAL const uint *face_starts, GLOBAL const uint *corners, GLOBAL const uint *edges,
                                 GLOBAL const row *strips, GLOBAL const uint *links, GLOBAL const uint *pair_leaf, GLOBAL const row *mesh_vertices,
                                 GLOBAL const uint *mesh_triangles, GLOBAL const row *positions, GLOBAL const row *orientations,
                                 GLOBAL const row *velocities, GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals,
                                 GLOBAL row *points, GLOBAL uint *counts_of_points, GLOBAL uint *features, uint method, uint i)
{
  if (!HAS_FEATURE(parameters, FEATURE_CONVEX) || !(normals[i].w >= AHEAD)) return;
  convex_query query;
  uint stride = counts[CAPACITY_PAIRS];
  int near = load_convex_query(&query, pair_a, pair_b, traits, shapes, convexes, poses, headers, vertices, planes, face_starts, corners, edges, strips,
                               links, pair_leaf, mesh_vertices, mesh_triangles, positions, orientations, velocities, parameters, method, i);
  if (near != QUERY_NEAR) return;
  manifold start = load_manifold(stride, normals, points, counts_of_points, features, i);
  start.impact_time = R(0.0);
  store_manifold_if(1, contact_over_step(parameters, &query, start, method & 255u), stride, normals, points, counts_of_points, features, i);
}

#endif
