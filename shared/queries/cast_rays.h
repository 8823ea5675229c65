/* cast_rays.h - the first body that each of many rays hits; see nearest.h and ray_shape.h. */
#ifndef TANDEM_SHARED_QUERIES_CAST_RAYS_H
#define TANDEM_SHARED_QUERIES_CAST_RAYS_H

#include "shared/queries/body_parts.h"
#include "shared/queries/ray_shape.h"

/* way: unit direction; length: in m, of a fraction of 1; reach: the largest fraction. */
SHARED first_hit hit_of_span(span s, vec3 direction, real length, real reach, uint body)
{
  first_hit hit = nothing_hit();
  if (is_nothing(s) || s.leave < R(0.0)) return hit;
  mask inside = s.enter < R(0.0);
  real distance = inside ? R(0.0) : s.enter;
  hit.fraction = distance / length;
  if (!(hit.fraction <= reach)) return hit;
  hit.body = body;
  hit.normal = inside ? negate(direction) : s.normal;
  hit.point = scale(direction, distance);
  return hit;
}

SHARED void cast_rays_item(GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL const uint *traits, GLOBAL const row *shapes, GLOBAL const uint *convexes,
                           GLOBAL const row *poses, GLOBAL const uint *headers, GLOBAL const row *vertices, GLOBAL const row *planes,
                           GLOBAL const uint *body_trees, GLOBAL const uint *tree_headers, GLOBAL const row *tree_frames, GLOBAL const uint *tree_nodes,
                           GLOBAL const uint *tree_leaves, GLOBAL const row *mesh_vertices, GLOBAL const uint *mesh_triangles,
                           GLOBAL const row *positions, GLOBAL const row *orientations, GLOBAL const uint *query_body,
                           GLOBAL const uint *query_filter, GLOBAL const row *query_start, GLOBAL const row *query_way,
                           GLOBAL row *query_hit, GLOBAL row *query_point, GLOBAL uint *query_hit_body, uint i)
{
  query_scene scene = {parameters, traits, convexes, body_trees, shapes, poses, orientations,
                       {headers, vertices, planes, 0, 0, 0, 0, 0, mesh_vertices, mesh_triangles, SUPPORT_BRUTE_FORCE}, {tree_headers, tree_frames, tree_nodes, tree_leaves}};
  place start = load_place(query_start, i);
  vec4 given = load_row(query_way, i);
  real length = length_of(xyz(given)), farthest = minimum(given.w * length, ENDLESS);
  vec3 direction = scale(xyz(given), R(1.0) / length), none = make_vec3(R(0.0), R(0.0), R(0.0));
  first_hit nearest = nothing_hit();
  for (uint body = 0u; body < counts[COUNT_BODIES]; ++body) {
    if (!may_hit(traits, query_body, query_filter, body, i)) continue;
    vec3 center = seen_from(positions, body, start);
    real reach = nearest.body == INDEX_NONE ? farthest : minimum(farthest, nearest.fraction * length);
    mask endless = shape_of(traits[body]) == (uint)SHAPE_HALF_SPACE;
    /* As long as the ray need be to pass the body: one without an end has no length to work with. */
    real way = minimum(reach, length_of(center) + load_row(shapes, body).w);
    if (!endless && !passes_near(center, scale(direction, way), load_row(shapes, body).w)) continue;
    part_walk walk = walk_parts(&scene, body, center, scale(direction, way), R(0.0));
    convex part;
    while (next_part(&scene, &walk, &part))
      nearest = nearer_hit(nearest, hit_of_span(ray_span(&part, none, direction), direction, length, given.w, query_body[4u * body]));
  }
  store_hit(nearest, query_hit, query_point, query_hit_body, i);
}

#endif
