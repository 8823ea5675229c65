/* cast_rays.h - the kernels that find what each of many rays hits: the nearest body, any body, or all of them. They use
 * nearest.h, ray_shape.h and body_walk.h. */
#ifndef TANDEM_SHARED_QUERIES_CAST_RAYS_H
#define TANDEM_SHARED_QUERIES_CAST_RAYS_H

#include "shared/queries/body_parts.h"

/* direction: unit. length: in m, of a fraction of 1. reach: the largest fraction. */
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

/* Ray i, and the search for the bodies that it may meet. */
typedef struct {
  double_float3 start;
  vec3 direction;               /* unit */
  real length, reach, farthest; /* length of a fraction of 1, m; the largest fraction; that fraction in m */
  uint query;
  body_walk walk;
} ray;

SHARED void load_ray(const query_scene *scene, uint i, ray *r)
{
  vec4 given = load_float4(scene->query_displacement, i);
  r->start = load_position(scene->query_start, i);
  r->length = length_of(xyz(given));
  r->reach = given.w;
  r->farthest = minimum(given.w * r->length, ENDLESS);
  r->direction = scale(xyz(given), R(1.0) / r->length);
  r->query = i;
  start_body_walk(&r->walk, &scene->bodies, r->start, r->direction, make_vec3(R(0.0), R(0.0), R(0.0)));
}

/* The next body that the ray may meet before `reach`, in m; INDEX_NONE after the last. */
SHARED uint next_body_on_ray(const query_scene *scene, ray *r, real reach)
{
  return next_body_on_path(&r->walk, &scene->bodies, reach);
}

/* The first hit of the ray on a body. */
SHARED first_hit hit_of_body(const query_scene *scene, const ray *r, uint body, real reach)
{
  first_hit nearest = nothing_hit();
  if (!may_hit(scene->flags, scene->query_body, scene->query_filter, body, r->query)) return nearest;
  vec3 center = seen_from(scene->positions, body, r->start), none = make_vec3(R(0.0), R(0.0), R(0.0));
  /* The ray is cut to the length that it needs to pass the body, because an infinite ray has no usable length. */
  real distance = minimum(reach, length_of(center) + load_float4(scene->shapes, body).w);
  part_walk walk = walk_parts(scene, body, center, scale(r->direction, distance), R(0.0));
  convex part;
  while (next_part(scene, &walk, &part))
    nearest = nearer_hit(nearest, hit_of_span(ray_span(&part, none, r->direction), r->direction, r->length, r->reach,
                                              scene->query_body[4u * body]));
  return nearest;
}

SHARED void cast_rays_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                           read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                           read_queries queries, write_hits hits, uint structure, uint i)
{
  query_scene scene =
      query_scene_of(parameters, search_structures, shapes, surfaces, trees, bodies, queries, structure);
  ray r;
  load_ray(&scene, i, &r);
  first_hit nearest = nothing_hit();
  real reach = r.farthest;
  for (uint body = next_body_on_ray(&scene, &r, reach); body != INDEX_NONE;
       body = next_body_on_ray(&scene, &r, reach)) {
    nearest = nearer_hit(nearest, hit_of_body(&scene, &r, body, reach));
    if (nearest.body != INDEX_NONE) reach = minimum(r.farthest, nearest.fraction * r.length);
  }
  store_hit(nearest, hits, i);
}

/* Whether the ray hits anything: 1 or 0. */
SHARED void cast_rays_any_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                               read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                               read_queries queries, GLOBAL uint *query_found, uint structure, uint i)
{
  query_scene scene =
      query_scene_of(parameters, search_structures, shapes, surfaces, trees, bodies, queries, structure);
  ray r;
  load_ray(&scene, i, &r);
  uint found = 0u;
  for (uint body = next_body_on_ray(&scene, &r, r.farthest); body != INDEX_NONE && found == 0u;
       body = next_body_on_ray(&scene, &r, r.farthest))
    if (hit_of_body(&scene, &r, body, r.farthest).body != INDEX_NONE) found = 1u;
  query_found[i] = found;
}

/* The number of bodies that the ray hits; after a scan, the next kernel writes them. */
SHARED void count_ray_hits_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                                read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                read_queries queries, GLOBAL uint *query_found, uint structure, uint i)
{
  query_scene scene =
      query_scene_of(parameters, search_structures, shapes, surfaces, trees, bodies, queries, structure);
  ray r;
  load_ray(&scene, i, &r);
  uint found = 0u;
  for (uint body = next_body_on_ray(&scene, &r, r.farthest); body != INDEX_NONE;
       body = next_body_on_ray(&scene, &r, r.farthest))
    if (hit_of_body(&scene, &r, body, r.farthest).body != INDEX_NONE) ++found;
  query_found[i] = found;
}

SHARED void write_ray_hits_item(GLOBAL const Parameters *parameters, read_search_structures search_structures,
                                read_shapes shapes, read_surfaces surfaces, read_trees trees, read_bodies bodies,
                                read_queries queries, GLOBAL const uint *query_found, write_hits hits, uint structure,
                                uint i)
{
  query_scene scene =
      query_scene_of(parameters, search_structures, shapes, surfaces, trees, bodies, queries, structure);
  ray r;
  load_ray(&scene, i, &r);
  uint at = query_found[i];
  for (uint body = next_body_on_ray(&scene, &r, r.farthest); body != INDEX_NONE;
       body = next_body_on_ray(&scene, &r, r.farthest)) {
    first_hit hit = hit_of_body(&scene, &r, body, r.farthest);
    if (hit.body != INDEX_NONE) store_hit(hit, hits, at++);
  }
}

#endif
