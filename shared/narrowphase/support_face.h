/* support_face.h - the feature of a shape's core that faces a direction, as a polygon whose corners are computed one by
 * one.
 *
 *   box, hull     the face at the farthest corner whose normal is nearest to the direction    its corners
 *   cylinder      the cap, if its normal is nearer to the direction than that of the side     8 corners on the rim
 *                 else the line on the side that faces the direction                          2
 *   capsule       the end, if the direction is less than 60 degrees from the axis             1
 *                 else the segment on the side                                                2
 *   sphere        its centre                                                                  1
 *   triangle      itself, from either side                                                    3
 *
 * If the cosine between a polygon's normal and the direction is below FACE_LEAST_COSINE, the feature is the farthest
 * point only. Corners run counter-clockwise seen from outside, about the origin that the pair is seen from. Of faces
 * whose normals are nearly equally near to the direction the lowest index wins, so that noise does not change the
 * choice.
 *
 *       .-- * --.     One corner of a cap is where the rim lies farthest in the direction, so that a tilted cylinder
 *      *    |    *    keeps its deepest point. Below CAP_LEAST_TILT the corners are fixed to the body instead, because
 *      *    o    *    the tilt of a cylinder at rest is noise; this costs at most 0.08 times the tilt times the radius.
 *       '-- * --'
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SUPPORT_FACE_H
#define TANDEM_SHARED_NARROWPHASE_SUPPORT_FACE_H

#include "shared/narrowphase/polytope.h"

#define CAP_CORNERS 8u
#define CAP_LEAST_TILT R(1e-3)
#define FACE_LEAST_COSINE R(0.05)
#define FACE_LEAD R(1e-3)

typedef struct {
  uint corners;
  uint feature;               /* index in the shape: the face; or 0 and 1 the caps, 2 the side, 3 and 4 the ends */
  vec3 normal;                /* outward; set for three corners or more */
  vec3 first_end, second_end; /* set for one or two corners */
  vec3 phase;                 /* unit, from the axis of a cylinder to the first corner of a cap */
  mask turned;                /* whether a triangle is seen from behind */
} support_face;

SHARED support_face point_feature(vec3 point, uint feature)
{
  support_face face;
  face.corners = 1u;
  face.feature = feature;
  face.normal = face.phase = make_vec3(R(0.0), R(0.0), R(0.0));
  face.first_end = face.second_end = point;
  face.turned = 0;
  return face;
}
SHARED support_face segment_feature(vec3 from, vec3 to, uint feature)
{
  support_face face = point_feature(from, feature);
  face.corners = 2u;
  face.second_end = to;
  return face;
}

SHARED uint box_face_toward(vec3 own)
{
  vec3 size = absolute(own);
  uint axis = size.y > size.x + FACE_LEAD ? 1u : 0u;
  if (size.z > coordinate(size, axis) + FACE_LEAD) axis = 2u;
  return axis * 2u + (coordinate(own, axis) < R(0.0) ? 1u : 0u);
}

/* Only the faces at the farthest vertex count: a face elsewhere may be more perpendicular to the direction, yet
 * lower. */
SHARED uint hull_face_toward(const convex *shape, vec3 own)
{
  uint_lanes vertex = support_vertex(shape, own);
  GLOBAL const uint *links = shape->tables.links + shape->hull.first_link;
  uint best = 0u;
  real most = R(-2.0);
  for (uint k = links[vertex]; k < links[vertex + 1u]; ++k) {
    real cosine = dot3(xyz(plane_of_face(shape, links[k])), own);
    if (cosine <= most + FACE_LEAD) continue;
    most = cosine;
    best = links[k];
  }
  return best;
}

SHARED support_face face_of_polytope(const convex *shape, uint k)
{
  support_face face = point_feature(make_vec3(R(0.0), R(0.0), R(0.0)), k);
  face.corners = corners_of_face(shape, k);
  face.normal = from_shape_axes(shape, xyz(plane_of_face(shape, k)));
  return face;
}
SHARED support_face polytope_feature(const convex *shape, vec3 own)
{
  return face_of_polytope(shape, shape->kind == (uint)SHAPE_BOX ? box_face_toward(own) : hull_face_toward(shape, own));
}

SHARED support_face cylinder_feature(const convex *shape, vec3 own)
{
  vec3 outward = around_axis(own), size = shape->size;
  real across = outward.x * own.x + outward.z * own.z;
  /* The side is inclined to the axis by the difference of the radii over the length. */
  real taper = size.x - size.z, length = square_root(taper * taper + R(4.0) * size.y * size.y);
  real cosine_of_side = (across * R(2.0) * size.y + own.y * taper) / length;
  mask top = own.y > R(0.0);
  real radius = top ? size.z : size.x;
  if (magnitude(own.y) < cosine_of_side || radius <= R(0.0)) {
    vec3 low = make_vec3(outward.x * size.x, -size.y, outward.z * size.x),
         high = make_vec3(outward.x * size.z, size.y, outward.z * size.z);
    return segment_feature(point_of_shape(shape, low), point_of_shape(shape, high), 2u);
  }
  support_face face = point_feature(make_vec3(R(0.0), R(0.0), R(0.0)), top ? 1u : 0u);
  face.corners = CAP_CORNERS;
  face.normal = from_shape_axes(shape, make_vec3(R(0.0), top ? R(1.0) : R(-1.0), R(0.0)));
  face.phase = across > CAP_LEAST_TILT ? outward : make_vec3(R(1.0), R(0.0), R(0.0));
  return face;
}

SHARED support_face capsule_feature(const convex *shape, vec3 own)
{
  real least = minimum(shape->size.x, shape->size.z);
  vec3 low = scale(own, shape->size.x - least), high = scale(own, shape->size.z - least);
  low.y = low.y - shape->size.y;
  high.y = high.y + shape->size.y;
  if (own.y > R(0.5)) return point_feature(point_of_shape(shape, high), 4u);
  if (own.y < R(-0.5)) return point_feature(point_of_shape(shape, low), 3u);
  return segment_feature(point_of_shape(shape, low), point_of_shape(shape, high), 2u);
}

/* The unit normal on the side from which the corners run counter-clockwise. Meshes hold no triangle without a normal
 * (host/geometry/triangle_mesh.h). */
SHARED vec3 normal_of_triangle(const convex *shape)
{
  vec3 normal = cross3(shape->second, shape->third);
  return scale(normal, R(1.0) / length_of(normal));
}
SHARED support_face triangle_feature(const convex *shape, vec3 own)
{
  vec3 normal = normal_of_triangle(shape);
  support_face face = point_feature(make_vec3(R(0.0), R(0.0), R(0.0)), 0u);
  face.corners = 3u;
  face.turned = dot3(normal, own) < R(0.0);
  face.normal = from_shape_axes(shape, face.turned ? negate(normal) : normal);
  return face;
}

/* direction: unit, out of the shape toward the other one. */
SHARED support_face support_face_of(const convex *shape, vec3 direction)
{
  vec3 own = to_shape_axes(shape, direction);
  support_face face;
  if (is_polytope(shape)) face = polytope_feature(shape, own);
  else if (is_cylinder(shape)) face = cylinder_feature(shape, own);
  else if (is_capsule(shape)) face = capsule_feature(shape, own);
  else if (is_triangle(shape)) face = triangle_feature(shape, own);
  else return point_feature(shape->center, 0u);
  if (face.corners > 2u && dot3(face.normal, direction) < FACE_LEAST_COSINE)
    return point_feature(support_of(shape, direction), face.feature);
  return face;
}

/* Corner k of a cap: the phase rotated by k eighths of a turn. */
SHARED vec3 cap_corner(const convex *shape, const support_face *face, uint k)
{
  real diagonal = R(0.70710678118654752);
  uint n = k & 3u;
  real cosine = n == 0u ? R(1.0) : n == 1u ? diagonal : n == 2u ? R(0.0) : -diagonal;
  real sine = n == 0u ? R(0.0) : n == 2u ? R(1.0) : diagonal;
  if (k >= 4u) {
    cosine = -cosine;
    sine = -sine;
  }
  mask top = face->feature == 1u;
  real radius = top ? shape->size.z : shape->size.x, turn = top ? -sine : sine;
  real x = face->phase.x * cosine - face->phase.z * turn, z = face->phase.x * turn + face->phase.z * cosine;
  return make_vec3(x * radius, top ? shape->size.y : -shape->size.y, z * radius);
}

SHARED vec3 triangle_corner(const convex *shape, uint k)
{
  return k == 0u ? make_vec3(R(0.0), R(0.0), R(0.0)) : k == 1u ? shape->second : shape->third;
}

SHARED vec3 face_corner(const convex *shape, const support_face *face, uint k)
{
  if (face->corners <= 2u) return k == 0u ? face->first_end : face->second_end;
  if (is_cylinder(shape)) return point_of_shape(shape, cap_corner(shape, face, k));
  if (is_triangle(shape)) return point_of_shape(shape, triangle_corner(shape, face->turned && k > 0u ? 3u - k : k));
  return point_of_shape(shape, corner_of_face(shape, face->feature, k));
}

#endif
