/* hull_axes.h - the axis along which two polytopes are separated most, or overlap least.
 *
 * It is either a face normal or perpendicular to two edges that meet on the Gauss map. An edge is there the arc between
 * the normals of its two faces; an edge pair forms a face of a - b only if an arc of a crosses an arc of -b
 * (D. Gregorius, "The separating axis test between convex polyhedra", GDC 2013).
 *
 *           left of a                Ties prefer faces, and those of the larger shape, as in box_axes.h: faces carry up
 *              |   right of -b       to four points and an edge pair one, and a body at rest must keep its axis.
 *     ---------+---------
 *   left of -b |
 *          right of a
 *
 * A few points of the other shape, called probes here, rule out nearly all axes. No gap beyond a face is larger than
 * the distance by which any one probe lies beyond that face:
 *
 *        a  \   . p                1  Only the face beyond which the nearest probe lies farthest is examined. The point
 *      ______\__.____ face            of b nearest to it becomes the next probe. After two or three faces no other one
 *             \  b                    could be better, so the best is found and proven.
 *                                  2  The axes of an edge pair lie on the arc between the normals of its faces. If no
 *                                     gap is positive, no edge pair is therefore better than the better one of the two
 *                                     faces. Where a face touches a face, that rules out every edge pair.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_HULL_AXES_H
#define TANDEM_SHARED_NARROWPHASE_HULL_AXES_H

#include "shared/narrowphase/polytope.h"

enum { AXIS_OF_FACE_A = 0, AXIS_OF_FACE_B = 1, AXIS_OF_EDGES = 2 };

#define PROBES 6u
#define FACE_LOOKS 16u
#define EDGES_LISTED 24u

typedef struct {
  core_contact contact;
  uint kind;
  uint feature_a, feature_b; /* the face, or the two edges */
} hull_axis;

/* The search for the face of one shape beyond which the other shape lies farthest. */
typedef struct {
  vec3 probe[PROBES]; /* points of the other shape, in the axes of this one */
  uint probes;
  uint main; /* the probe nearest to the face, or deepest behind it */
  uint face;
  real gap; /* of the other shape beyond that face */
} face_search;

/* --- faces -------------------------------------------------------------------------------------------- */

SHARED void add_probe(face_search *s, const convex *shape, vec3 point)
{
  s->probe[s->probes % PROBES] = to_shape_axes(shape, subtract(point, shape->center));
  s->probes = s->probes + 1u;
}

SHARED uint probes_of(const face_search *s) { return s->probes < PROBES ? s->probes : PROBES; }

typedef struct {
  float8 x, y, z, distance;
} plane_chunk;

SHARED void load_plane_chunk(plane_chunk *planes, const convex *shape, uint k)
{
  if (is_hull(shape)) {
    uint at = shape->hull.first_chunk + (chunks_of(shape->hull.vertices) * 3u + k * 4u) * FLOAT4S_OF_CHUNK;
    load_float8(&planes->x, shape->tables.chunks, at);
    load_float8(&planes->y, shape->tables.chunks, at + FLOAT4S_OF_CHUNK);
    load_float8(&planes->z, shape->tables.chunks, at + 2u * FLOAT4S_OF_CHUNK);
    load_float8(&planes->distance, shape->tables.chunks, at + 3u * FLOAT4S_OF_CHUNK);
    return;
  }
  vec3 size = shape->size;
  real one = R(1.0), none = R(0.0);
  planes->x = CHUNK_OF(one, -one, none, none, none, none, one, one);
  planes->y = CHUNK_OF(none, none, one, -one, none, none, none, none);
  planes->z = CHUNK_OF(none, none, none, none, one, -one, none, none);
  planes->distance = CHUNK_OF(size.x, size.x, size.y, size.y, size.z, size.z, size.x, size.x);
}

/* How far a point lies beyond each of eight faces. */
SHARED void beyond_planes(float8 *beyond, const plane_chunk *planes, vec3 p)
{
  *beyond = planes->x * p.x + planes->y * p.y + planes->z * p.z - planes->distance;
}

/* Upper bounds of the gap beyond each of eight faces. */
SHARED void bound_by_probes(float8 *bound, const face_search *s, const convex *shape, uint k)
{
  plane_chunk planes;
  load_plane_chunk(&planes, shape, k);
  beyond_planes(bound, &planes, s->probe[0]);
  for (uint j = 1u; j < probes_of(s); ++j) {
    float8 beyond;
    beyond_planes(&beyond, &planes, s->probe[j]);
    *bound = CHUNK_CHOOSE(beyond < *bound, beyond, *bound);
  }
}

SHARED highest_entry farthest_bound(const face_search *s, const convex *shape)
{
  chunk_leader best;
  start_chunk_leader(&best);
  for (uint k = 0u; k < chunks_of(faces_of(shape)); ++k) {
    float8 bound;
    bound_by_probes(&bound, s, shape, k);
    challenge_by_chunk(&best, &bound, k * CHUNK);
  }
  return highest_of_chunk(&best);
}

/* The point of the other shape nearest to a face, or deepest behind it, becomes a probe. */
SHARED void look_at_face(face_search *s, const convex *shape, const convex *other, uint k)
{
  vec4 plane = plane_of_face(shape, k);
  vec3 nearest = support_of(other, negate(from_shape_axes(shape, xyz(plane))));
  uint at = s->probes % PROBES;
  add_probe(s, shape, nearest);
  real gap = dot3(xyz(plane), s->probe[at]) - plane.w;
  if (gap <= s->gap) return;
  s->gap = gap;
  s->face = k;
  s->main = at;
}

/* least: gaps up to this do not matter. enough: a gap beyond this need not be the largest. */
SHARED void search_faces(face_search *s, const convex *shape, const convex *other, real least, real enough)
{
  s->gap = R(-1e30);
  s->face = s->main = 0u;
  for (uint look = 0u; look < FACE_LOOKS + faces_of(shape); ++look) {
    mask bounded = look < FACE_LOOKS;
    highest_entry top = {R(1e30), look - FACE_LOOKS};
    if (bounded) top = farthest_bound(s, shape);
    if (bounded && top.height <= maximum(s->gap, least)) return;
    look_at_face(s, shape, other, top.at);
    if (bounded && (s->gap >= top.height || s->gap > enough)) return;
  }
}

/* --- edges -------------------------------------------------------------------------------------------- */

/* The edges that may matter. If there are more than the list holds, all edges of the shape count. */
typedef struct {
  uint edge[EDGES_LISTED];
  uint count;
} edge_list;

SHARED void list_edge(edge_list *list, uint edge)
{
  uint kept = list->count < EDGES_LISTED ? list->count : EDGES_LISTED;
  for (uint k = 0u; k < kept; ++k)
    if (list->edge[k] == edge) return;
  if (kept < EDGES_LISTED) list->edge[kept] = edge;
  list->count = list->count + 1u;
}
SHARED uint edges_listed(const edge_list *list, const convex *shape)
{
  return list->count <= EDGES_LISTED ? list->count : edges_of(shape);
}
SHARED uint listed_edge(const edge_list *list, uint k) { return list->count <= EDGES_LISTED ? list->edge[k] : k; }

/* Whether every probe allows an axis on the arc between the normals of the two faces to show a gap above `least`. */
SHARED mask edge_may_matter(const face_search *s, const convex *shape, uint left, uint right, real least)
{
  vec4 plane_left = plane_of_face(shape, left), plane_right = plane_of_face(shape, right);
  for (uint j = 0u; j < probes_of(s); ++j)
    if (dot3(xyz(plane_left), s->probe[j]) - plane_left.w <= least &&
        dot3(xyz(plane_right), s->probe[j]) - plane_right.w <= least)
      return 0;
  return 1;
}

SHARED void list_edges_of_face(edge_list *list, const face_search *s, const convex *shape, uint face, real least)
{
  if (!is_hull(shape)) {
    for (uint k = 0u; k < 12u; ++k)
      if (face_of_box_edge(k, 0u) == face || face_of_box_edge(k, 1u) == face)
        if (edge_may_matter(s, shape, face_of_box_edge(k, 0u), face_of_box_edge(k, 1u), least)) list_edge(list, k);
    return;
  }
  GLOBAL const uint *start = shape->tables.face_starts + shape->hull.first_face + face;
  GLOBAL const uint *edge_of_corner =
      shape->tables.links + shape->hull.first_link + shape->hull.vertices + 1u + shape->hull.corners;
  for (uint c = start[0]; c < start[1]; ++c) {
    uint edge = edge_of_corner[c - shape->hull.first_corner];
    if (edge == INDEX_NONE) continue;
    GLOBAL const uint *entry = shape->tables.edges + 4u * (shape->hull.first_edge + edge);
    if (edge_may_matter(s, shape, entry[2], entry[3], least)) list_edge(list, edge);
  }
}

/* Lists the edges that no probe rules out: the main probe must lie beyond one of their faces. */
SHARED void list_edges(edge_list *list, const face_search *s, const convex *shape, real least)
{
  list->count = 0u;
  for (uint k = 0u; k < chunks_of(faces_of(shape)); ++k) {
    plane_chunk planes;
    float8 beyond;
    real bounds[8];
    load_plane_chunk(&planes, shape, k);
    beyond_planes(&beyond, &planes, s->probe[s->main]);
    store_float8(bounds, &beyond);
    for (uint n = 0u; n < CHUNK; ++n)
      if (bounds[n] > least && k * CHUNK + n < faces_of(shape))
        list_edges_of_face(list, s, shape, k * CHUNK + n, least);
  }
}

/* Whether the arcs of the two edges cross on the Gauss map. */
SHARED mask arcs_cross(const polytope_edge *a, const polytope_edge *b)
{
  real left_b = dot3(b->left, a->along), right_b = dot3(b->right, a->along);
  if (left_b * right_b >= R(0.0)) return 0;
  real left_a = dot3(a->left, b->along), right_a = dot3(a->right, b->along);
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

/* noise: the rounding error of the gap between two perpendicular edges. It grows as the edges come closer to
 * parallel. */
SHARED hull_axis best_edges(hull_axis best, const convex *a, const edge_list *list_a, const convex *b,
                            const edge_list *list_b, real noise)
{
  real highest = best.contact.gap;
  for (uint k = 0u; k < edges_listed(list_b, b); ++k) {
    uint index_b = listed_edge(list_b, k);
    polytope_edge edge_b = placed_edge(b, index_b);
    for (uint j = 0u; j < edges_listed(list_a, a); ++j) {
      uint index_a = listed_edge(list_a, j);
      polytope_edge edge_a = edge_of(a, index_a); /* the larger shape is seen in its own axes */
      if (!arcs_cross(&edge_a, &edge_b)) continue;
      edge_a.start = add(edge_a.start, a->center);
      vec3 axis = cross3(edge_a.along, edge_b.along);
      real squared = length_squared(axis), size = length_squared(edge_a.along) * length_squared(edge_b.along);
      if (squared <= R(1e-8) * size) continue;
      axis =
          scale(axis, (dot3(axis, add(edge_a.left, edge_a.right)) < R(0.0) ? R(-1.0) : R(1.0)) / square_root(squared));
      real gap = dot3(axis, subtract(edge_b.start, edge_a.start)), score = gap - noise * square_root(size / squared);
      if (score <= highest) continue;
      highest = score;
      best.contact.gap = gap;
      best.contact.normal = axis;
      best.kind = AXIS_OF_EDGES;
      best.feature_a = index_a;
      best.feature_b = index_b;
    }
  }
  return best;
}

/* --- both --------------------------------------------------------------------------------------------- */

SHARED hull_axis axis_of_face(const face_search *s, const convex *shape, uint kind)
{
  vec3 outward = from_shape_axes(shape, xyz(plane_of_face(shape, s->face)));
  hull_axis axis;
  axis.contact.normal = kind == (uint)AXIS_OF_FACE_A ? outward : negate(outward);
  axis.contact.gap = s->gap;
  axis.kind = kind;
  axis.feature_a = axis.feature_b = s->face;
  return axis;
}

SHARED hull_axis axis_between_centers(const convex *a, const convex *b)
{
  vec3 between = subtract(b->center, a->center);
  real distance = length_of(between);
  hull_axis axis;
  axis.contact.normal = distance > R(0.0) ? scale(between, R(1.0) / distance) : make_vec3(R(0.0), R(1.0), R(0.0));
  axis.kind = AXIS_OF_EDGES;
  axis.feature_a = axis.feature_b = 0u;
  return axis;
}

/* The best axis of an edge pair, if it leads by more than `lead`; else `best`. */
SHARED hull_axis better_edges(hull_axis best, const convex *a, const face_search *faces_a, const convex *b,
                              const face_search *faces_b, real lead)
{
  real least = best.contact.gap + lead, surely = minimum(least, R(0.0));
  edge_list list_a, list_b;
  list_edges(&list_a, faces_a, a, surely);
  if (list_a.count == 0u) return best;
  list_edges(&list_b, faces_b, b, surely);
  if (list_b.count == 0u) return best;
  hull_axis none = best;
  none.contact.gap = R(-1e30);
  hull_axis edges =
      best_edges(none, a, &list_a, b, &list_b, R(2.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b)));
  return edges.contact.gap > least ? edges : best;
}

/* The shapes must be boxes or hulls as pair_of() returns them. lead: the margin by which a later kind of axis must be
 * better. limit: a gap beyond this need not be the largest. Edge pairs are not tried if a face separates the shapes,
 * because their closest points are then computed anyway. */
SHARED hull_axis separating_hull_axis(const convex *a, const convex *b, real lead, real limit)
{
  hull_axis best = axis_between_centers(a, b);
  vec3 of_a = support_of(a, best.contact.normal), of_b = support_of(b, negate(best.contact.normal));
  best.contact.gap = dot3(subtract(of_b, of_a), best.contact.normal);
  if (best.contact.gap > limit) return best;

  face_search faces_a, faces_b;
  faces_a.probes = faces_b.probes = 0u;
  add_probe(&faces_a, a, of_b);
  search_faces(&faces_a, a, b, R(-1e30), limit);
  best = axis_of_face(&faces_a, a, AXIS_OF_FACE_A);
  if (faces_a.gap > limit) return best;

  add_probe(&faces_b, b, of_a);
  for (uint k = 0u; k < 3u; ++k)
    add_probe(&faces_b, b,
              point_of_shape(a, corner_of_face(a, faces_a.face, k * corners_of_face(a, faces_a.face) / 3u)));
  search_faces(&faces_b, b, a, faces_a.gap + lead, limit);
  if (faces_b.gap > faces_a.gap + lead) best = axis_of_face(&faces_b, b, AXIS_OF_FACE_B);
  return best.contact.gap > R(0.0) ? best : better_edges(best, a, &faces_a, b, &faces_b, lead);
}

#endif
