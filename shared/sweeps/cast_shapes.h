/* cast_shapes.h - the first body that a convex shape touches along each of many straight paths.
 *
 * The kernel uses conservative advancement (narrowphase/conservative_advancement.h). Without rotation its bound is
 * exact along the normal, and a few distance queries for each body are enough. The path ends up to the touching
 * distance of that method before the body, never behind it.
 */
#ifndef TANDEM_SHARED_SWEEPS_CAST_SHAPES_H
#define TANDEM_SHARED_SWEEPS_CAST_SHAPES_H

#include "shared/queries/body_parts.h"

/* A share of the least size. It is smaller than that of contacts, because a query must be more precise. */
#define CAST_TOUCHING R(1e-5)

SHARED toi_input cast_input(real length, real horizon, real least, real size)
{
  toi_input input = {horizon, CAST_TOUCHING * least + R(16.0) * ROUNDING * (length * horizon + size), length, R(0.0),
                     1};
  return input;
}

/* The point of the surface of b that a touches at the impact. */
SHARED vec3 touched_point(const convex *a, const convex *b, impact met)
{
  convex_pair pair = pair_of(a, b);
  gjk_result near = closest_points(&pair.a, &pair.b, R(1e30));
  vec3 core = near.overlapping ? pair.b.center : pair.swapped ? near.on_a : near.on_b;
  return add_scaled(add(pair.origin, rotate(pair.axes, core)), met.normal, -core_radius(b));
}

/* moving: seen from its start. body: at rest, seen from the same point. */
SHARED first_hit cast_against(const moving_convex *moving, const convex *body, mask is_plane, real reach, uint number)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  real length = length_of(moving->linear), least = least_size(&moving->shape),
       size = bounding_radius_of(&moving->shape);
  first_hit hit = nothing_hit();
  impact met;
  if (is_plane) {
    vec3 up = axis_y(body->rotation);
    met = first_impact_on_plane(moving, up, dot3(up, body->center), none, cast_input(length, reach, least, size));
    convex arrived = shape_at(moving, none, met.at.time);
    hit.point = add_scaled(support_of(&arrived, met.normal), met.normal, core_radius(&arrived) + met.gap);
  } else {
    moving_convex standing = moving_convex_of(body, body->center, none, none, R(0.0));
    met = first_impact(&standing, moving,
                       cast_input(length, reach, minimum(least, least_size(body)), size + bounding_radius_of(body)));
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

/* Casts query i against all parts of a body. radius: of the shape that is cast. */
SHARED first_hit cast_against_body(const query_scene *scene, const moving_convex *moving, real radius, uint body,
                                   uint i)
{
  first_hit nearest = nothing_hit();
  if (!may_hit(scene->flags, scene->query_body, scene->query_filter, body, i)) return nearest;
  vec3 center = seen_from(scene->positions, body, load_position(scene->query_start, i));
  mask is_plane = shape_of(scene->flags[body]) == (uint)SHAPE_HALF_SPACE;
  if (!is_plane && !passes_near(center, moving->linear, load_float4(scene->shapes, body).w + radius)) return nearest;
  part_walk walk = walk_parts(scene, body, center, moving->linear, radius);
  convex part;
  while (next_part(scene, &walk, &part))
    nearest = nearer_hit(nearest, cast_against(moving, &part, is_plane, R(1.0), scene->query_body[4u * body]));
  return nearest;
}

/* Query i's shape, seen from its start. vertices: their number if it is a hull. queries.shape holds its size and
 * bounding radius. */
SHARED convex load_query_shape(read_shape_queries queries, uint kind, uint vertices, uint i)
{
  hull_tables own = {0, queries.vertex, 0, 0, 0, 0, queries.chunk, 0, 0, 0, SUPPORT_BRUTE_FORCE};
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  mat3 rotation = rotation_of(quat_from(load_float4(queries.turn, i)));
  convex shape = convex_of(SHAPE_BOX, xyz(load_float4(queries.shape, 0u)), rotation, none, none, 0u, own);
  shape.kind = kind;
  shape.hull.vertices = vertices;
  return shape;
}

/* Starts the search for the bodies that query i's shape may meet along its displacement. */
SHARED void start_shape_walk(body_walk *walk, const body_structure *bodies, read_shape_queries queries, uint i)
{
  real slack = R(1.001) * load_float4(queries.shape, 0u).w; /* includes the touching distance */
  start_body_walk(walk, bodies, load_position(queries.start, i), xyz(load_float4(queries.displacement, i)),
                  make_vec3(slack, slack, slack));
}

SHARED query_scene scene_of_shape_queries(GLOBAL const Parameters *parameters,
                                          read_search_structures search_structures, read_shapes shapes,
                                          read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                          read_shape_queries shape_queries, uint structure)
{
  read_queries queries = {shape_queries.body, shape_queries.filter, shape_queries.start, shape_queries.displacement};
  return query_scene_of(parameters, search_structures, shapes, surfaces, trees, bodies, queries, structure);
}

SHARED void cast_shapes_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                             read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                             read_shape_queries shape_queries, write_hits hits, uint kind, uint vertices,
                             uint structure, uint i)
{
  query_scene scene = scene_of_shape_queries(parameters, search_structures, shapes, surfaces, trees, bodies,
                                             shape_queries, structure);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), displacement = xyz(load_float4(shape_queries.displacement, i));
  convex swept = load_query_shape(shape_queries, kind, vertices, i);
  moving_convex moving = moving_convex_of(&swept, none, displacement, none, R(0.0));
  first_hit nearest = nothing_hit();
  real reach = R(1.0), radius = load_float4(shape_queries.shape, 0u).w;
  body_walk walk;
  start_shape_walk(&walk, &scene.bodies, shape_queries, i);
  for (uint body = next_body_on_path(&walk, &scene.bodies, reach); body != INDEX_NONE;
       body = next_body_on_path(&walk, &scene.bodies, reach)) {
    nearest = nearer_hit(nearest, cast_against_body(&scene, &moving, radius, body, i));
    if (nearest.body != INDEX_NONE) reach = minimum(R(1.0), nearest.fraction);
  }
  store_hit(nearest, hits, i);
}

#endif
