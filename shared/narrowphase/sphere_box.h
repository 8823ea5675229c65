/* sphere_box.h - a sphere touches a box where the box comes nearest to the sphere's centre.
 *
 *      +---------+          Outside: the centre clamped to the box is the nearest point.
 *      |         |--> o     Inside: the face of least depth pushes the sphere out.
 *      |     o-->|
 *      +---------+
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_BOX_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_BOX_H

#include "shared/narrowphase/manifold.h"

/* Outward from the surface of a box toward a point, both in the axes of the box. */
typedef struct {
  vec3 normal;
  real distance; /* negative inside */
} box_distance;

SHARED box_distance distance_to_box(vec3 point, vec3 extent)
{
  vec3 nearest = make_vec3(clamped(point.x, -extent.x, extent.x), clamped(point.y, -extent.y, extent.y),
                           clamped(point.z, -extent.z, extent.z));
  vec3 away = subtract(point, nearest);
  real distance = length_of(away);
  mask outside = distance > R(1e-12);

  vec3 depth = subtract(extent, absolute(point));
  mask x_least = (depth.x <= depth.y) & (depth.x <= depth.z);
  mask y_least = (!x_least) & (depth.y <= depth.z);
  mask z_least = (!x_least) & (!y_least);
  real zero = R(0.0);
  vec3 face = make_vec3(choose(x_least, sign_of(point.x), zero), choose(y_least, sign_of(point.y), zero),
                        choose(z_least, sign_of(point.z), zero));
  real least = choose(x_least, depth.x, choose(y_least, depth.y, depth.z));

  box_distance result;
  result.normal = choose3(outside, scale(away, R(1.0) / choose(outside, distance, (real)R(1.0))), face);
  result.distance = choose(outside, distance, -least);
  return result;
}

SHARED void collide_sphere_box_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                                    GLOBAL const row *shapes, GLOBAL const row *positions,
                                    GLOBAL const row *orientations, GLOBAL const row *velocities,
                                    GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals,
                                    GLOBAL row *points, GLOBAL uint *counts_of_points, GLOBAL uint *features, item_index i)
{
  natural a = load_natural(pair_a, i), b = load_natural(pair_b, i);
  natural shape_a = shape_of(load_natural(traits, a)), shape_b = shape_of(load_natural(traits, b));
  mask sphere_first = (shape_a == (uint)SHAPE_SPHERE) & (shape_b == (uint)SHAPE_BOX);
  mask mine = sphere_first | ((shape_a == (uint)SHAPE_BOX) & (shape_b == (uint)SHAPE_SPHERE));
  if (!any_of(mine)) return;

  natural sphere = choose(sphere_first, a, b), box = choose(sphere_first, b, a);
  real radius = load_row(shapes, sphere).x;
  vec4 shape = load_row(shapes, box);
  mat3 rotation = rotation_of(quat_from(load_row(orientations, box)));
  vec3 center = offset_between(positions, box, sphere);
  box_distance nearest = distance_to_box(rotate_back(rotation, center), xyz(shape));
  vec3 outward = rotate(rotation, nearest.normal);
  vec3 normal = choose3(sphere_first, negate(outward), outward);
  real separation = nearest.distance - radius;

  vec3 from_sphere = scale(outward, -(radius + separation * R(0.5)));
  vec3 offset = choose3(sphere_first, from_sphere, add(center, from_sphere));
  real reach = reach_of(parameters, load_motion(velocities, a), choose(sphere_first, (real)R(0.0), shape.w),
                        load_motion(velocities, b), choose(sphere_first, shape.w, (real)R(0.0)), normal);
  manifold m = single_contact(normal, offset, separation, separation < reach);
  store_manifold_if(mine, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

#endif
