/* sphere_sphere.h - two spheres touch in one point on the line of their centres. */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_SPHERE_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_SPHERE_H

#include "shared/narrowphase/manifold.h"

SHARED void collide_sphere_sphere_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                                       GLOBAL const row *shapes, GLOBAL const row *positions,
                                       GLOBAL const row *velocities, GLOBAL const Parameters *parameters,
                                       GLOBAL const uint *counts, GLOBAL row *normals, GLOBAL row *points,
                                       GLOBAL uint *counts_of_points, GLOBAL uint *features, item_index i)
{
  natural a = load_natural(pair_a, i), b = load_natural(pair_b, i);
  natural shape_a = shape_of(load_natural(traits, a)), shape_b = shape_of(load_natural(traits, b));
  mask mine = (shape_a == (uint)SHAPE_SPHERE) & (shape_b == (uint)SHAPE_SPHERE);
  if (!any_of(mine)) return;

  real radius_a = load_row(shapes, a).x, radius_b = load_row(shapes, b).x;
  vec3 between = offset_between(positions, a, b);
  real distance = length_of(between);
  mask apart = distance > R(1e-12);
  vec3 normal = choose3(apart, scale(between, R(1.0) / choose(apart, distance, (real)R(1.0))), parting_direction(a, b));
  real separation = distance - radius_a - radius_b;

  real reach = reach_of(parameters, load_motion(velocities, a), R(0.0), load_motion(velocities, b), R(0.0), normal);
  manifold m = single_contact(normal, scale(normal, radius_a + separation * R(0.5)), separation, separation < reach);
  store_manifold_if(mine, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

#endif
