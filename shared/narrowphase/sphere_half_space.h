/* sphere_half_space.h - the contact of a sphere with a half-space, below the sphere's centre.
 *
 * The half-space contains all points with y <= 0 in its body's frame; its outward normal is the body's +Y.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_HALF_SPACE_H

#include "shared/narrowphase/manifold.h"
#include "shared/narrowphase/pair_lists.h"

SHARED void collide_sphere_half_space_item(read_listed_pairs pairs, GLOBAL const uint *flags,
                                           GLOBAL const float4 *shapes, read_bodies bodies,
                                           GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                           write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, flags, PAIR_KIND_SPHERE_HALF_SPACE, i);
  if (!any_of(item.mine)) return;
  uint_lanes a = item.a, b = item.b;
  mask mine = item.mine;
  mask sphere_first = shape_of(load_uint(flags, a)) == (uint)SHAPE_SPHERE;

  uint_lanes sphere = choose(sphere_first, a, b), plane = choose(sphere_first, b, a);
  real radius = load_float4(shapes, sphere).x;
  vec3 outward = axis_y(rotation_of(quat_from(load_float4(bodies.orientation, plane))));
  vec3 center = offset_between(bodies.position, plane, sphere);
  vec3 normal = choose3(sphere_first, negate(outward), outward);
  real separation = dot3(center, outward) - radius;

  vec3 from_sphere = scale(outward, -(radius + separation * R(0.5)));
  vec3 offset = choose3(sphere_first, from_sphere, add(center, from_sphere));
  real reach = reach_of(parameters, load_velocity(bodies.velocity, a), R(0.0), load_velocity(bodies.velocity, b),
                        R(0.0), normal);
  manifold m = single_contact(normal, offset, separation, separation < reach);
  store_manifold_if(mine, m, planes_of(counts), manifolds, item.pair);
}

#endif
