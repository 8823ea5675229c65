/* box_half_space.h - a box touches a half-space with the four corners of the face turned most toward it.
 *
 * The lowest corner of the box is always among them. Slots are the signs of the two other axes of the
 * face: bit 0 the next axis, bit 1 the one after.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_BOX_HALF_SPACE_H

#include "shared/narrowphase/box.h"

/* Corner of the face `toward` the plane; `origin` is where offsets are counted from, seen from the box. */
SHARED vec4 corner_contact(vec3 corner, vec3 center, vec3 outward, vec3 origin)
{
  real separation = inner(center, outward) + inner(corner, outward);
  return extend(add_scaled(subtract(corner, origin), outward, separation * R(-0.5)), separation);
}

SHARED manifold box_on_plane(oriented_box box, vec3 center, vec3 outward, vec3 origin, real reach)
{
  natural k = most_parallel_axis(box, outward);
  box_frame face = frame_of(box, k);
  real side = -sign_of(inner(face.axis, outward));
  vec3 middle = scale(face.axis, face.extent * side);
  vec3 u = scale(face.u, face.extent_u), v = scale(face.v, face.extent_v);
  manifold m;
  m.normal = outward;
  m.code = (k << 1u) | choose(side > R(0.0), (natural)1u, (natural)0u);
  m.point[0] = corner_contact(subtract(subtract(middle, u), v), center, outward, origin);
  m.point[1] = corner_contact(subtract(add(middle, u), v), center, outward, origin);
  m.point[2] = corner_contact(add(subtract(middle, u), v), center, outward, origin);
  m.point[3] = corner_contact(add(add(middle, u), v), center, outward, origin);
  for (int slot = 0; slot < 4; ++slot) m.kept[slot] = m.point[slot].w < reach;
  return m;
}

SHARED void collide_box_half_space_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                                        GLOBAL const row *shapes, GLOBAL const row *positions,
                                        GLOBAL const row *orientations, GLOBAL const row *velocities,
                                        GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                        GLOBAL row *normals, GLOBAL row *points, GLOBAL uint *counts_of_points,
                                        GLOBAL uint *features, item_index i)
{
  natural a = load_natural(pair_a, i), b = load_natural(pair_b, i);
  natural shape_a = shape_of(load_natural(traits, a)), shape_b = shape_of(load_natural(traits, b));
  mask box_first = (shape_a == (uint)SHAPE_BOX) & (shape_b == (uint)SHAPE_HALF_SPACE);
  mask mine = box_first | ((shape_a == (uint)SHAPE_HALF_SPACE) & (shape_b == (uint)SHAPE_BOX));
  if (!any_of(mine)) return;

  natural body = choose(box_first, a, b), plane = choose(box_first, b, a);
  vec4 shape = load_row(shapes, body);
  oriented_box box = oriented_box_of(load_row(orientations, body), xyz(shape));
  vec3 outward = axis_y(rotation_of(quat_from(load_row(orientations, plane))));
  vec3 center = offset_between(positions, plane, body);
  vec3 here = make_vec3(R(0.0), R(0.0), R(0.0));
  vec3 normal = choose3(box_first, negate(outward), outward);
  real zero = R(0.0);
  real reach = reach_of(parameters, load_motion(velocities, a), choose(box_first, shape.w, zero),
                        load_motion(velocities, b), choose(box_first, zero, shape.w), normal);
  manifold m = box_on_plane(box, center, outward, choose3(box_first, here, negate(center)), reach);
  m.normal = normal;
  store_manifold_if(mine, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

#endif
