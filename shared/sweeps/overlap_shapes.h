/* overlap_shapes.h - every body that a convex shape overlaps, for each of many poses.
 *
 *        +------+           An overlap test is the first distance query of a shape cast (cast_shapes.h): the gap of the
 *        |   .--+--.        cores less their radii, in the axes of the larger shape. The gap that GJK finds is a true
 *        +--(---+   )       lower bound (narrowphase/gjk.h), so a body that is left out lies apart, and one that is
 *            `----'         reported lies apart by no more than rounding.
 *
 * The hits of each query are counted, the counts are scanned, and the bodies are written. A query reads no displacement
 * but 0, so that it walks the structures of bodies as a cast does.
 */
#ifndef TANDEM_SHARED_SWEEPS_OVERLAP_SHAPES_H
#define TANDEM_SHARED_SWEEPS_OVERLAP_SHAPES_H

#include "shared/sweeps/cast_shapes.h"

SHARED mask overlaps_convex(const convex *shape, const convex *part)
{
  convex_pair pair = pair_of(shape, part);
  real radii = core_radius(shape) + core_radius(part);
  gjk_result near = closest_points(&pair.a, &pair.b, radii);
  return near.overlapping || near.contact.gap <= radii;
}

SHARED mask overlaps_half_space(const convex *shape, const convex *plane)
{
  vec3 up = axis_y(plane->rotation);
  return dot3(up, support_of(shape, negate(up))) - core_radius(shape) <= dot3(up, plane->center);
}

/* Whether query i's shape overlaps any part of a body. radius: the bounding radius of the shape. */
SHARED mask overlaps_body(const query_scene *scene, const convex *shape, real radius, uint body, uint i)
{
  if (!may_hit(scene->flags, scene->query_body, scene->query_filter, body, i)) return 0;
  vec3 center = seen_from(scene->positions, body, load_position(scene->query_start, i)),
       none = make_vec3(R(0.0), R(0.0), R(0.0));
  mask is_plane = shape_of(scene->flags[body]) == (uint)SHAPE_HALF_SPACE;
  if (!is_plane && !passes_near(center, none, load_float4(scene->shapes, body).w + radius)) return 0;
  part_walk walk = walk_parts(scene, body, center, none, radius);
  convex part;
  while (next_part(scene, &walk, &part))
    if (is_plane ? overlaps_half_space(shape, &part) : overlaps_convex(shape, &part)) return 1;
  return 0;
}

/* The next body that query i's shape overlaps; INDEX_NONE after the last. */
SHARED uint next_overlapped_body(const query_scene *scene, body_walk *walk, const convex *shape, real radius, uint i)
{
  for (uint body = next_body_on_path(walk, &scene->bodies, R(1.0)); body != INDEX_NONE;
       body = next_body_on_path(walk, &scene->bodies, R(1.0)))
    if (overlaps_body(scene, shape, radius, body, i)) return body;
  return INDEX_NONE;
}

/* kind: SHAPE_ in the low SHAPE_KIND_BITS, above them the number of vertices if the shape is a hull. */
SHARED void count_shape_overlaps_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                                      read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                      read_shape_queries shape_queries, GLOBAL uint *query_found, uint kind,
                                      uint structure, uint i)
{
  query_scene scene = scene_of_shape_queries(parameters, search_structures, shapes, surfaces, trees, bodies,
                                             shape_queries, structure);
  convex shape = load_query_shape(shape_queries, kind & SHAPE_KIND_MASK, kind >> SHAPE_KIND_BITS, i);
  real radius = load_float4(shape_queries.shape, 0u).w;
  body_walk walk;
  start_shape_walk(&walk, &scene.bodies, shape_queries, i);
  uint found = 0u;
  while (next_overlapped_body(&scene, &walk, &shape, radius, i) != INDEX_NONE) ++found;
  query_found[i] = found;
}

SHARED void write_shape_overlaps_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                                      read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                      read_shape_queries shape_queries, GLOBAL const uint *query_found,
                                      GLOBAL uint *query_hit_body, uint kind, uint structure, uint i)
{
  query_scene scene = scene_of_shape_queries(parameters, search_structures, shapes, surfaces, trees, bodies,
                                             shape_queries, structure);
  convex shape = load_query_shape(shape_queries, kind & SHAPE_KIND_MASK, kind >> SHAPE_KIND_BITS, i);
  real radius = load_float4(shape_queries.shape, 0u).w;
  body_walk walk;
  start_shape_walk(&walk, &scene.bodies, shape_queries, i);
  uint at = query_found[i];
  for (uint body = next_overlapped_body(&scene, &walk, &shape, radius, i); body != INDEX_NONE;
       body = next_overlapped_body(&scene, &walk, &shape, radius, i))
    query_hit_body[at++] = scene.query_body[4u * body];
}

#endif
