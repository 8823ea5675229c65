/* polytope.h - faces, edges and corners of both boxes and hulls, in the shape's own axes.
 *
 *   box   face 2 k is +axis k, face 2 k + 1 is -axis k. Edge 4 k + (sign of u) + 2 (sign of v) is parallel to axis k;
 *         u and v are the two axes after k in cyclic order, and a set bit is the positive side.
 *   hull  as its tables say (hull_support.h)
 */
#ifndef TANDEM_SHARED_NARROWPHASE_POLYTOPE_H
#define TANDEM_SHARED_NARROWPHASE_POLYTOPE_H

#include "shared/narrowphase/convex.h"

SHARED real coordinate(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
/* x is along an axis, y and z are along the two axes after it in cyclic order. */
SHARED vec3 from_axis(uint axis, real x, real y, real z)
{
  return axis == 0u ? make_vec3(x, y, z) : axis == 1u ? make_vec3(z, x, y) : make_vec3(y, z, x);
}

SHARED mask is_polytope(const convex *shape) { return shape->kind == (uint)SHAPE_BOX || is_hull(shape); }
SHARED uint faces_of(const convex *shape) { return is_hull(shape) ? shape->hull.faces : 6u; }
SHARED uint edges_of(const convex *shape) { return is_hull(shape) ? shape->hull.edges : 12u; }

/* The outward unit normal, and the distance from the origin. */
SHARED vec4 plane_of_face(const convex *shape, uint k)
{
  if (is_hull(shape)) return load_float4(shape->tables.planes, shape->hull.first_face + k);
  vec3 normal = from_axis(k >> 1u, (k & 1u) == 1u ? R(-1.0) : R(1.0), R(0.0), R(0.0));
  return extend(normal, coordinate(shape->size, k >> 1u));
}

SHARED uint corners_of_face(const convex *shape, uint k)
{
  if (!is_hull(shape)) return 4u;
  GLOBAL const uint *start = shape->tables.face_starts + shape->hull.first_face + k;
  return start[1] - start[0];
}
SHARED vec3 corner_of_face(const convex *shape, uint k, uint corner)
{
  if (is_hull(shape))
    return hull_vertex(shape, shape->tables.corners[shape->tables.face_starts[shape->hull.first_face + k] + corner]);
  uint axis = k >> 1u;
  real side = (k & 1u) == 1u ? R(-1.0) : R(1.0);
  real u = corner == 1u || corner == 2u ? side : -side, v = corner >= 2u ? R(1.0) : R(-1.0);
  return multiply(from_axis(axis, side, u, v), shape->size);
}

/* An edge as its start and its vector to the other end. The cross product of the normals of the faces to its left and
 * right points along it. */
typedef struct {
  vec3 start, along, left, right;
} polytope_edge;

SHARED polytope_edge edge_of_box(vec3 extent, uint k)
{
  uint axis = k >> 2u;
  real u = (k & 1u) == 1u ? R(1.0) : R(-1.0), v = (k & 2u) == 2u ? R(1.0) : R(-1.0);
  polytope_edge edge;
  edge.left = from_axis(axis, R(0.0), u, R(0.0));
  edge.right = from_axis(axis, R(0.0), R(0.0), v);
  real sense = u * v;
  edge.start = multiply(from_axis(axis, -sense, u, v), extent);
  edge.along = multiply(from_axis(axis, R(2.0) * sense, R(0.0), R(0.0)), extent);
  return edge;
}
/* The face to the left (side 0) or right (side 1) of an edge of a box. */
SHARED uint face_of_box_edge(uint edge, uint side)
{
  uint axis = ((edge >> 2u) + 1u + side) % 3u;
  return axis * 2u + (((edge >> side) & 1u) == 1u ? 0u : 1u);
}
SHARED polytope_edge edge_of(const convex *shape, uint k)
{
  if (!is_hull(shape)) return edge_of_box(shape->size, k);
  GLOBAL const uint *entry = shape->tables.edges + 4u * (shape->hull.first_edge + k);
  polytope_edge edge;
  edge.start = hull_vertex(shape, entry[0]);
  edge.along = subtract(hull_vertex(shape, entry[1]), edge.start);
  edge.left = xyz(load_float4(shape->tables.planes, shape->hull.first_face + entry[2]));
  edge.right = xyz(load_float4(shape->tables.planes, shape->hull.first_face + entry[3]));
  return edge;
}

#endif
