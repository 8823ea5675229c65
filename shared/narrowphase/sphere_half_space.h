/* sphere_half_space.h - a sphere touches a half-space below its centre.
 *
 * The half-space is all points with y <= 0 in its body's frame: its outward normal is the body's +Y.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H

#include "shared/narrowphase/manifold.h"
#include "shared/narrowphase/pair_lists.h"

SHARED void collide_sphere_half_space_item(read_listed_pairs pairs, GLOBAL const uint *traits, GLOBAL const row *shapes,
                                           read_bodies bodies, GLOBAL const Parameters *parameters,
                                           GLOBAL const uint *counts, write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, traits, PAIR_KIND_SPHERE_HALF_SPACE, i);
  if (!any_of(item.mine)) return;
  natural a = item.a, b = item.b;
  mask mine = item.mine;
  mask sphere_first = shape_of(load_natural(traits, a)) == (uint)SHAPE_SPHERE;

  natural sphere = choose(sphere_first, a, b), plane = choose(sphere_first, b, a);
  real radius = load_row(shapes, sphere).x;
  vec3 outward = axis_y(rotation_of(quat_from(load_row(bodies.orientation, plane))));
  vec3 center = offset_between(bodies.position, plane, sphere);
  vec3 normal = choose3(sphere_first, negate(outward), outward);
  real separation = inner(center, outward) - radius;

  vec3 from_sphere = scale(outward, -(radius + separation * R(0.5)));
  vec3 offset = choose3(sphere_first, from_sphere, add(center, from_sphere));
  real reach =
      reach_of(parameters, load_motion(bodies.velocity, a), R(0.0), load_motion(bodies.velocity, b), R(0.0), normal);
  manifold m = single_contact(normal, offset, separation, separation < reach);
  store_manifold_if(mine, m, counts[CAPACITY_PAIRS], manifolds, item.pair);
}

#endif
