/* box_queries.h - the bodies whose boxes overlap a given box, at rest or along a straight path.
 *
 * The boxes of bodies are those of compute_query_bounds, which enclose each shape at its current pose. The hits of each
 * query are counted, the counts are scanned, and the hits are written, each with the fraction of the path at which the
 * boxes touch.
 */
#ifndef TANDEM_SHARED_QUERIES_BOX_QUERIES_H
#define TANDEM_SHARED_QUERIES_BOX_QUERIES_H

#include "shared/queries/body_walk.h"
#include "shared/queries/nearest.h"

typedef struct {
  GLOBAL const uint *flags, *query_body, *query_filter;
  body_structure bodies;
  GLOBAL const float4 *query_start, *query_displacement, *query_extent;
} box_scene;

/* Box i and the search for the bodies that it may meet. */
typedef struct {
  uint query;
  body_walk walk;
} box_walk;

SHARED void start_box_walk(const box_scene *scene, uint i, box_walk *b)
{
  b->query = i;
  start_body_walk(&b->walk, &scene->bodies, load_position(scene->query_start, i),
                  xyz(load_float4(scene->query_displacement, i)), xyz(load_float4(scene->query_extent, i)));
}

/* The next body that the box meets, and the fraction of the path at which it does; INDEX_NONE after the last. A
 * half-space has no bounds, so it is always met. */
SHARED uint next_body_in_box(const box_scene *scene, box_walk *b, real *fraction)
{
  *fraction = R(0.0);
  for (uint body = next_body_on_path(&b->walk, &scene->bodies, R(1.0)); body != INDEX_NONE;
       body = next_body_on_path(&b->walk, &scene->bodies, R(1.0))) {
    if (!may_hit(scene->flags, scene->query_body, scene->query_filter, body, b->query)) continue;
    *fraction = way_into_body(&b->walk, &scene->bodies, body, R(1.0));
    if (*fraction < ENDLESS) return body;
  }
  return INDEX_NONE;
}

SHARED box_scene box_scene_of(read_search_structures search_structures, GLOBAL const uint *body_flags,
                              read_queries queries, GLOBAL const float4 *query_extent, uint structure)
{
  box_scene scene = {body_flags,    queries.body,         queries.filter, structure_of(search_structures, structure),
                     queries.start, queries.displacement, query_extent};
  return scene;
}

SHARED void count_box_hits_item(read_search_structures search_structures, GLOBAL const uint *body_flags,
                                read_queries queries, GLOBAL const float4 *query_extent, GLOBAL uint *query_found,
                                uint structure, uint i)
{
  box_scene scene = box_scene_of(search_structures, body_flags, queries, query_extent, structure);
  box_walk b;
  start_box_walk(&scene, i, &b);
  real fraction;
  uint found = 0u;
  while (next_body_in_box(&scene, &b, &fraction) != INDEX_NONE) ++found;
  query_found[i] = found;
}

SHARED void write_box_hits_item(read_search_structures search_structures, GLOBAL const uint *body_flags,
                                read_queries queries, GLOBAL const float4 *query_extent, GLOBAL const uint *query_found,
                                GLOBAL float4 *query_hit, GLOBAL uint *query_hit_body, uint structure, uint i)
{
  box_scene scene = box_scene_of(search_structures, body_flags, queries, query_extent, structure);
  box_walk b;
  start_box_walk(&scene, i, &b);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  real fraction;
  uint at = query_found[i];
  for (uint body = next_body_in_box(&scene, &b, &fraction); body != INDEX_NONE;
       body = next_body_in_box(&scene, &b, &fraction)) {
    store_float4(query_hit, at, extend(none, fraction));
    query_hit_body[at++] = queries.body[4u * body];
  }
}

#endif
