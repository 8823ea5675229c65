/* sweep_shape.h - the first body that a convex shape touches on each of many straight ways.
 *
 * By conservative advancement (narrowphase/conservative_advancement.h): without turning, its bound is exact along the
 * normal, and a few distance queries a body are enough. The way ends up to the touching distance of that method before
 * the body, never behind.
 */
#ifndef TANDEM_SHARED_SWEEPS_SWEEP_SHAPE_H
#define TANDEM_SHARED_SWEEPS_SWEEP_SHAPE_H

#include "shared/queries/body_parts.h"

/* Of the least size: a query is not served by the broad margin of a contact. */
#define SWEEP_TOUCHING R(1e-5)

SHARED journey sweep_journey(real length, real horizon, real least, real size)
{
  journey way = {horizon, SWEEP_TOUCHING * least + R(16.0) * ROUNDING * (length * horizon + size), length, R(0.0), 1};
  return way;
}

/* Where the surface of b is then, that a touches. */
SHARED vec3 touched_point(const convex *a, const convex *b, impact met)
{
  convex_pair pair = pair_of(a, b);
  gjk_result near = closest_points(&pair.a, &pair.b, R(1e30));
  vec3 core = near.overlapping ? pair.b.center : pair.swapped ? near.on_a : near.on_b;
  return add_scaled(add(pair.origin, rotate(pair.axes, core)), met.normal, -core_radius(b));
}

/* moving: seen from its start; body: standing, seen from the same place. */
SHARED first_hit sweep_against(const moving_convex *moving, const convex *body, mask is_plane, real reach, uint number)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  real length = length_of(moving->linear), least = least_size(&moving->shape),
       size = bounding_radius_of(&moving->shape);
  first_hit hit = nothing_hit();
  impact met;
  if (is_plane) {
    vec3 up = axis_y(body->rotation);
    met = first_impact_on_plane(moving, up, inner(up, body->center), none, sweep_journey(length, reach, least, size));
    convex arrived = shape_at(moving, none, met.at.time);
    hit.point = add_scaled(support_of(&arrived, met.normal), met.normal, core_radius(&arrived) + met.gap);
  } else {
    moving_convex standing = moving_convex_of(body, body->center, none, none, R(0.0));
    met = first_impact(&standing, moving,
                       sweep_journey(length, reach, minimum(least, least_size(body)), size + bounding_radius_of(body)));
    met.normal = negate(met.normal);
    convex arrived = shape_at(moving, none, met.at.time);
    if (met.at.hits) hit.point = touched_point(&arrived, body, met);
  }
  if (!met.at.hits) return nothing_hit();
  hit.body = number;
  hit.fraction = met.at.time;
  hit.normal = negate(met.normal);
  if (met.at.time > R(0.0) || met.gap > R(0.0)) return hit;
  hit.normal = length > R(0.0) ? scale(moving->linear, R(-1.0) / length) : none;
  hit.point = none;
  return hit;
}

/* Query i against all parts of a body. radius: of what is swept. */
SHARED first_hit sweep_against_body(const query_scene *scene, const moving_convex *moving, real radius, uint body,
                                    uint i)
{
  first_hit nearest = nothing_hit();
  if (!may_hit(scene->traits, scene->query_body, scene->query_filter, body, i)) return nearest;
  vec3 center = seen_from(scene->positions, body, load_place(scene->query_start, i));
  mask is_plane = shape_of(scene->traits[body]) == (uint)SHAPE_HALF_SPACE;
  if (!is_plane && !passes_near(center, moving->linear, load_row(scene->shapes, body).w + radius)) return nearest;
  part_walk walk = walk_parts(scene, body, center, moving->linear, radius);
  convex part;
  while (next_part(scene, &walk, &part))
    nearest = nearer_hit(nearest, sweep_against(moving, &part, is_plane, R(1.0), scene->query_body[4u * body]));
  return nearest;
}

/* vertices: of the swept shape, if it is a hull; its size and bounding radius in query_shape. */
SHARED void sweep_shape_item(
    GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL const uint *traits, GLOBAL const row *shapes,
    GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const uint *headers, GLOBAL const row *vertices,
    GLOBAL const row *strips, GLOBAL const uint *body_trees, GLOBAL const uint *tree_headers,
    GLOBAL const row *tree_frames, GLOBAL const uint *tree_nodes, GLOBAL const uint *tree_leaves,
    GLOBAL const row *mesh_vertices, GLOBAL const uint *mesh_triangles, GLOBAL const row *positions,
    GLOBAL const row *orientations, GLOBAL const row *hierarchy, GLOBAL const uint *hierarchy_link,
    GLOBAL const uint *leaf_body, GLOBAL const row *bounds, GLOBAL const row *grid, GLOBAL const uint *sort_value,
    GLOBAL const uint *cell_start, GLOBAL const uint *query_body, GLOBAL const uint *query_filter,
    GLOBAL const row *query_start, GLOBAL const row *query_turn, GLOBAL const row *query_way,
    GLOBAL const row *query_shape, GLOBAL const row *query_vertex, GLOBAL const row *query_strip, GLOBAL row *query_hit,
    GLOBAL row *query_point, GLOBAL uint *query_hit_body, uint kind, uint vertices_of_shape, uint structure, uint i)
{
  query_scene scene = {
      parameters,
      traits,
      convexes,
      body_trees,
      shapes,
      poses,
      positions,
      orientations,
      {headers, vertices, 0, 0, 0, 0, strips, 0, mesh_vertices, mesh_triangles, SUPPORT_BRUTE_FORCE},
      {tree_headers, tree_frames, tree_nodes, tree_leaves},
      {structure, {hierarchy, hierarchy_link, leaf_body, counts}, {bounds, grid, sort_value, cell_start, counts}},
      query_body,
      query_filter,
      query_start,
      query_way};
  hull_tables own = {0, query_vertex, 0, 0, 0, 0, query_strip, 0, 0, 0, SUPPORT_BRUTE_FORCE};
  place start = load_place(query_start, i);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), way = xyz(load_row(query_way, i));
  vec4 size = load_row(query_shape, 0u);
  mat3 rotation = rotation_of(quat_from(load_row(query_turn, i)));
  convex swept = convex_of(SHAPE_BOX, xyz(size), rotation, none, none, 0u, own);
  swept.kind = kind;
  swept.hull.vertices = vertices_of_shape;
  moving_convex moving = moving_convex_of(&swept, none, way, none, R(0.0));
  first_hit nearest = nothing_hit();
  real reach = R(1.0), slack = R(1.001) * size.w; /* what touches ahead is hit */
  body_walk walk;
  start_body_walk(&walk, &scene.bodies, start, way, make_vec3(slack, slack, slack));
  for (uint body = next_body_on_way(&walk, &scene.bodies, reach); body != INDEX_NONE;
       body = next_body_on_way(&walk, &scene.bodies, reach)) {
    nearest = nearer_hit(nearest, sweep_against_body(&scene, &moving, size.w, body, i));
    if (nearest.body != INDEX_NONE) reach = minimum(R(1.0), nearest.fraction);
  }
  store_hit(nearest, query_hit, query_point, query_hit_body, i);
}

#endif
