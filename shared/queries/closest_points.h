/* closest_points.h - the closest points of two bodies, for each of many pairs.
 *
 *      a .--.   on a      on b  +-----+ b     Parts of a near b's bounding ball are taken one by one; for each of them,
 *       (    )o- - - - - - - - -o     |       the parts of b whose box is nearer to the part than the nearest found so
 *        '--'    normal ->      +-----+       far. Both come from the trees of the bodies (body_parts.h). Of equally
 *                                             near parts the first ones count.
 *
 * The distance is the largest gap that GJK finds along any direction (narrowphase/gjk.h), less the radii, and the
 * normal is that direction. A pair is seen from the centre of the second body, a pair of parts from the middle of the
 * first part, so that coordinates near the points are small.
 */
#ifndef TANDEM_SHARED_QUERIES_CLOSEST_POINTS_H
#define TANDEM_SHARED_QUERIES_CLOSEST_POINTS_H

#include "shared/queries/body_parts.h"

/* Points are seen from where the parts are. Where they overlap, the distance is 0 and the rest has no meaning. */
typedef struct {
  real distance;
  vec3 normal; /* unit, from a to b */
  vec3 on_a, on_b;
} closest_pair;

SHARED closest_pair nothing_close(void)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  closest_pair pair = {ENDLESS, none, none, none};
  return pair;
}

/* limit: farther parts may get any distance above it. */
SHARED closest_pair closest_of_convexes(const convex *a, const convex *b, real limit)
{
  convex_pair pair = pair_of(a, b);
  real radius_a = core_radius(a), radius_b = core_radius(b), radii = radius_a + radius_b;
  gjk_result near = closest_points(&pair.a, &pair.b, limit + radii);
  closest_pair found = nothing_close();
  found.distance = near.overlapping ? R(0.0) : maximum(near.contact.gap - radii, R(0.0));
  if (found.distance <= R(0.0) || found.distance > limit) return found;
  vec3 along = rotate(pair.axes, near.contact.normal), one = add(pair.origin, rotate(pair.axes, near.on_a)),
       other = add(pair.origin, rotate(pair.axes, near.on_b));
  found.normal = pair.swapped ? negate(along) : along;
  found.on_a = add_scaled(pair.swapped ? other : one, found.normal, radius_a);
  found.on_b = add_scaled(pair.swapped ? one : other, found.normal, -radius_b);
  return found;
}

SHARED closest_pair closest_of_half_space(const convex *plane, const convex *b)
{
  vec3 up = axis_y(plane->rotation), lowest = add_scaled(support_of(b, negate(up)), up, -core_radius(b));
  closest_pair found = nothing_close();
  found.distance = maximum(dot3(up, subtract(lowest, plane->center)), R(0.0));
  found.normal = up;
  found.on_a = add_scaled(lowest, up, -found.distance);
  found.on_b = lowest;
  return found;
}

/* The closest points of a part and the parts of body b, if these are nearer than `limit`; seen from the middle of the
 * part. center: of body b, seen from there. is_plane: the part is a half-space, which has no bounding ball. */
SHARED closest_pair closest_of_part(const query_scene *scene, const convex *part, mask is_plane, uint b, vec3 center,
                                    real limit)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  part_walk walk = walk_parts(scene, b, center, none, R(0.0));
  real around = (walk.has_tree ? walk.radius : R(0.0)) + bounding_radius_of(part);
  closest_pair nearest = nothing_close();
  nearest.distance = limit;
  convex other;
  walk.radius = is_plane ? ENDLESS : around + nearest.distance;
  while (nearest.distance > R(0.0) && next_part(scene, &walk, &other)) {
    closest_pair found =
        is_plane ? closest_of_half_space(part, &other) : closest_of_convexes(part, &other, nearest.distance);
    if (!(found.distance < nearest.distance)) continue;
    nearest = found;
    if (!is_plane) walk.radius = around + nearest.distance;
  }
  return nearest;
}

/* The closest points of two bodies, seen from the centre of b. offset: of the centre of a. A half-space is body a. */
SHARED closest_pair closest_of_bodies(const query_scene *scene, uint a, uint b, vec3 offset)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  mask is_plane = shape_of(scene->flags[a]) == (uint)SHAPE_HALF_SPACE;
  part_walk walk = walk_parts(scene, a, offset, none, R(0.0));
  real around = (walk.has_tree ? walk.radius : R(0.0)) + load_float4(scene->shapes, b).w;
  closest_pair nearest = nothing_close();
  convex part;
  walk.radius = ENDLESS;
  while (nearest.distance > R(0.0) && next_part(scene, &walk, &part)) {
    vec3 middle = part.center;
    part.center = none;
    closest_pair found = closest_of_part(scene, &part, is_plane, b, negate(middle), nearest.distance);
    if (!(found.distance < nearest.distance)) continue;
    nearest = found;
    nearest.on_a = add(found.on_a, middle);
    nearest.on_b = add(found.on_b, middle);
    walk.radius = around + nearest.distance;
  }
  return nearest;
}

SHARED closest_pair exchanged_pair(closest_pair pair)
{
  closest_pair other = {pair.distance, negate(pair.normal), pair.on_b, pair.on_a};
  return other;
}

/* closest_normal: the normal and the distance. closest_point: the points, seen from the centre of the second body, and
 * that centre. */
SHARED void find_closest_points_item(GLOBAL const Parameters *parameters, read_shapes shapes, read_surfaces surfaces,
                                     read_trees trees, read_bodies bodies, GLOBAL const uint *query_pair,
                                     GLOBAL float4 *closest_normal, GLOBAL float4 *closest_point, uint i)
{
  query_scene scene;
  set_bodies_of_scene(&scene, parameters, shapes, surfaces, trees, bodies);
  uint a = query_pair[2u * i], b = query_pair[2u * i + 1u];
  vec3 offset = seen_from(bodies.position, a, load_position(bodies.position, b));
  mask turned = shape_of(shapes.flags[b]) == (uint)SHAPE_HALF_SPACE;
  closest_pair found = turned ? exchanged_pair(closest_of_bodies(&scene, b, a, negate(offset)))
                              : closest_of_bodies(&scene, a, b, offset);
  if (turned) {
    found.on_a = add(found.on_a, offset);
    found.on_b = add(found.on_b, offset);
  }
  mask apart = found.distance > R(0.0);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_float4(closest_normal, i, extend(apart ? found.normal : none, found.distance));
  store_float4(closest_point, 4u * i, extend(apart ? found.on_a : none, R(0.0)));
  store_float4(closest_point, 4u * i + 1u, extend(apart ? found.on_b : none, R(0.0)));
  store_float4(closest_point, 4u * i + 2u, load_float4(bodies.position, 2u * b));
  store_float4(closest_point, 4u * i + 3u, load_float4(bodies.position, 2u * b + 1u));
}

#endif
