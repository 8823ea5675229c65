/* convex_half_space.h - the manifold of a convex shape on a half-space, from the corners of its supporting feature.
 *
 *         .-----.
 *        /       \       The supporting feature is the face, edge or point turned to the plane. Its corners within
 *       '----+----'      reach are reduced to four as in contact_points.h. The farthest point of the shape is one
 *    ------------------  more candidate, so a rounded or steep shape keeps its deepest point.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONVEX_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_CONVEX_HALF_SPACE_H

#include "shared/narrowphase/contact_points.h"
#include "shared/narrowphase/support_face.h"

/* up: unit normal of the plane. height: height of the plane along `up` above the origin that the shape is seen from. */
SHARED clip_point corner_above_plane(vec3 corner, tangents axes, vec3 up, real height, real reach)
{
  clip_point point;
  point.u = dot3(axes.first, corner);
  point.v = dot3(axes.second, corner);
  point.separation = dot3(up, corner) - height;
  point.valid = point.separation < reach;
  return point;
}

/* The shape's centre must be near the origin it is seen from (its own body's centre). The normal points from the shape
 * into the half-space; points are offsets from the same origin, midway between the surfaces. */
SHARED manifold convex_on_half_space(const convex *shape, vec3 up, real height, real reach)
{
  tangents axes = tangents_of(up);
  vec3 down = negate(up);
  real radius = core_radius(shape), size = bounding_radius_of(shape), level = height + radius;
  support_face face = support_face_of(shape, down);
  clip_point four[4], lowest = corner_above_plane(support_of(shape, down), axes, up, level, reach);
  reduction r;
  start_reduction(&r, size, R(32.0) * ROUNDING * size);
  do {
    for (uint k = 0u; k < face.corners; ++k)
      reduce_step(&r, corner_above_plane(face_corner(shape, &face, k), axes, up, level, reach));
    reduce_step(&r, lowest);
  } while (next_pass(&r));
  finish_reduction(four, &r);
  manifold m;
  m.normal = down;
  m.impact_time = R(0.0);
  m.code = face.feature & 0xfffu;
  for (int slot = 0; slot < 4; ++slot) {
    vec3 flat = add_scaled(scale(axes.first, four[slot].u), axes.second, four[slot].v);
    m.point[slot] = extend(add_scaled(flat, up, height + four[slot].separation * R(0.5)), four[slot].separation);
    m.kept[slot] = four[slot].valid;
  }
  return kept_within(m, reach);
}

#endif
