/* hull_axes.h - the axis along which two polytopes are farthest apart, or overlap least, by trying all that can be it.
 *
 * All faces of both, and of the pairs of edges those that meet on the Gauss map: an edge is there the arc between the
 * normals of its two faces, and only where an arc of a crosses an arc of -b have the edges a face of a - b between them.
 * (D. Gregorius, "The separating axis test between convex polyhedra", GDC 2013.)
 *
 *           left of a                Ties prefer faces, and those of the larger shape, as in box_axes.h: faces carry up to
 *              |   right of -b       four points, an edge one, and a body at rest must keep its axis.
 *     ---------+---------
 *   left of -b |
 *          right of a
 */
#ifndef TANDEM_SHARED_NARROWPHASE_HULL_AXES_H
#define TANDEM_SHARED_NARROWPHASE_HULL_AXES_H

#include "shared/narrowphase/polytope.h"

enum { AXIS_OF_FACE_A = 0, AXIS_OF_FACE_B = 1, AXIS_OF_EDGES = 2 };

typedef struct {
  core_contact contact;
  uint kind;
  uint feature_a, feature_b; /* the face, or the two edges */
} hull_axis;

/* The deepest of the gaps over the faces of `shape`. sense: 1 if its outward normals point from a to b. */
SHARED hull_axis best_face(hull_axis best, const convex *a, const convex *b, uint kind, real lead)
{
  const convex *shape = kind == (uint)AXIS_OF_FACE_A ? a : b;
  mask of_a = kind == (uint)AXIS_OF_FACE_A;
  for (uint k = 0u; k < faces_of(shape); ++k) {
    vec4 plane = plane_of_face(shape, k);
    vec3 outward = from_shape_axes(shape, xyz(plane));
    vec3 against = support_of(of_a ? b : a, negate(outward));
    real gap = inner(subtract(against, shape->center), outward) - plane.w;
    if (gap <= best.contact.gap + lead) continue;
    best.contact.gap = gap;
    best.contact.normal = of_a ? outward : negate(outward);
    best.kind = kind;
    best.feature_a = best.feature_b = k;
    lead = minimum(lead, ROUNDING * magnitude(gap));
  }
  return best;
}

/* Do the arcs of the two edges cross on the Gauss map? */
SHARED mask arcs_cross(const polytope_edge *a, const polytope_edge *b)
{
  real left_b = inner(b->left, a->along), right_b = inner(b->right, a->along);
  if (left_b * right_b >= R(0.0)) return 0;
  real left_a = inner(a->left, b->along), right_a = inner(a->right, b->along);
  return left_a * right_a < R(0.0) && left_b * right_a < R(0.0);
}

SHARED polytope_edge placed_edge(const convex *shape, uint k)
{
  polytope_edge edge = edge_of(shape, k);
  edge.start = point_of_shape(shape, edge.start);
  edge.along = from_shape_axes(shape, edge.along);
  edge.left = from_shape_axes(shape, edge.left);
  edge.right = from_shape_axes(shape, edge.right);
  return edge;
}

/* noise: what rounding makes of the gap between two edges square to each other; the nearer to parallel, the more. */
SHARED hull_axis best_edges(hull_axis best, const convex *a, const convex *b, real noise)
{
  real highest = best.contact.gap;
  for (uint k = 0u; k < edges_of(b); ++k) {
    polytope_edge edge_b = placed_edge(b, k);
    for (uint j = 0u; j < edges_of(a); ++j) {
      polytope_edge edge_a = edge_of(a, j); /* the larger shape is seen in its own axes */
      if (!arcs_cross(&edge_a, &edge_b)) continue;
      edge_a.start = add(edge_a.start, a->center);
      vec3 axis = outer(edge_a.along, edge_b.along);
      real squared = length_squared(axis), size = length_squared(edge_a.along) * length_squared(edge_b.along);
      if (squared <= R(1e-8) * size) continue;
      axis = scale(axis, (inner(axis, add(edge_a.left, edge_a.right)) < R(0.0) ? R(-1.0) : R(1.0)) / square_root(squared));
      real gap = inner(axis, subtract(edge_b.start, edge_a.start)), score = gap - noise * square_root(size / squared);
      if (score <= highest) continue;
      highest = score;
      best.contact.gap = gap;
      best.contact.normal = axis;
      best.kind = AXIS_OF_EDGES;
      best.feature_a = j;
      best.feature_b = k;
    }
  }
  return best;
}

/* Boxes and hulls only, as pair_of() gives them. lead: what a later kind of axis must be better by. */
SHARED hull_axis separating_hull_axis(const convex *a, const convex *b, real lead)
{
  hull_axis none;
  none.contact.gap = R(-1e30);
  none.contact.normal = make_vec3(R(0.0), R(1.0), R(0.0));
  none.kind = AXIS_OF_FACE_A;
  none.feature_a = none.feature_b = 0u;
  hull_axis best = best_face(none, a, b, AXIS_OF_FACE_A, R(0.0));
  best = best_face(best, a, b, AXIS_OF_FACE_B, lead);
  real noise = R(2.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b));
  hull_axis edges = best_edges(none, a, b, noise);
  return edges.contact.gap > best.contact.gap + lead ? edges : best;
}

#endif
