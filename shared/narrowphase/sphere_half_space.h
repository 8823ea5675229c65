/* sphere_half_space.h - a sphere touches a half-space below its centre.
 *
 * The half-space is all points with y <= 0 in its body's frame: its outward normal is the body's +Y.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H

#include "shared/narrowphase/manifold.h"

SHARED void collide_sphere_half_space_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                                           GLOBAL const uint *traits, GLOBAL const row *shapes,
                                           GLOBAL const row *positions, GLOBAL const row *orientations,
                                           GLOBAL const row *velocities, GLOBAL const Parameters *parameters,
                                           GLOBAL const uint *counts, GLOBAL row *normals, GLOBAL row *points,
                                           GLOBAL uint *counts_of_points, GLOBAL uint *features, item_index i)
{
  natural a = load_natural(pair_a, i), b = load_natural(pair_b, i);
  natural shape_a = shape_of(load_natural(traits, a)), shape_b = shape_of(load_natural(traits, b));
  mask sphere_first = (shape_a == (uint)SHAPE_SPHERE) & (shape_b == (uint)SHAPE_HALF_SPACE);
  mask mine = sphere_first | ((shape_a == (uint)SHAPE_HALF_SPACE) & (shape_b == (uint)SHAPE_SPHERE));
  if (!any_of(mine)) return;

  natural sphere = choose(sphere_first, a, b), plane = choose(sphere_first, b, a);
  real radius = load_row(shapes, sphere).x;
  vec3 outward = axis_y(rotation_of(quat_from(load_row(orientations, plane))));
  vec3 center = offset_between(positions, plane, sphere);
  vec3 normal = choose3(sphere_first, negate(outward), outward);
  real separation = inner(center, outward) - radius;

  vec3 from_sphere = scale(outward, -(radius + separation * R(0.5)));
  vec3 offset = choose3(sphere_first, from_sphere, add(center, from_sphere));
  real reach = reach_of(parameters, load_motion(velocities, a), R(0.0), load_motion(velocities, b), R(0.0), normal);
  manifold m = single_contact(normal, offset, separation, separation < reach);
  store_manifold_if(mine, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

#endif
