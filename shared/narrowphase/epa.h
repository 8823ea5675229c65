/* epa.h - how deep two convex cores overlap, and along which normal: the expanding polytope algorithm.
 *
 *        .-----.        A polytope inside a - b grows where it is nearest to the origin, until the face found there is
 *      .'   o   '.      a face of a - b itself, or the support beyond it no farther than rounding (G. van den Bergen,
 *      |    |----*      "Proximity queries and penetration depth computation on 3D game objects", GDC 2001).
 *      '.       .'
 *        '-----'        Every normal tried gives a true upper bound of the depth; the least of them is the answer,
 *                       whatever became of the polytope.
 *
 * It starts from the points of a - b farthest apart rather than from the simplex of gjk.h: that simplex is flat just
 * where shapes touch. For the same reason distances are signed: an origin outside the polytope, by rounding or because
 * the shapes are a little apart, only makes the nearest face the one it is farthest outside of. Where a - b itself is
 * flat (segments, points) its plane gives the normal.
 *
 * The faces that a new point sees are removed. Which ones they are is a matter of rounding, so the hole is closed edge
 * by edge: each edge of a removed face whose other face stays gets a new face. The surface stays closed whatever was
 * removed.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_EPA_H
#define TANDEM_SHARED_NARROWPHASE_EPA_H

#include "shared/narrowphase/convex.h"

#define EPA_VERTICES 32
#define EPA_FACES 64
#define EPA_ROUNDS 64
#define EPA_FAR R(1e30)
#define EPA_TRIED (1u << 24u)

typedef struct {
  vec3 w[EPA_VERTICES];
  vec3 normal[EPA_FACES]; /* outward; 0 for a face without area, which is never nearest and never seen */
  real distance[EPA_FACES];
  uint corners[EPA_FACES]; /* three vertices of 8 bits, counter-clockwise seen from outside; EPA_TRIED: no point lies
                              beyond */
  int vertices, faces;
} polytope;

typedef struct {
  core_contact contact;
  real error; /* the depth is at least the one found less this */
} epa_result;

SHARED uint corner_of(uint corners, uint k) { return (corners >> (k * 8u)) & 255u; }

/* The normal from the two shorter edges, whose product is the most accurate; 0 if the triangle is flatter than
 * rounding. */
SHARED vec3 triangle_normal(vec3 p, vec3 q, vec3 r, real noise)
{
  vec3 pq = subtract(q, p), qr = subtract(r, q), rp = subtract(p, r);
  real pq2 = length_squared(pq), qr2 = length_squared(qr), rp2 = length_squared(rp);
  real longest = maximum(pq2, maximum(qr2, rp2));
  vec3 normal = pq2 == longest ? cross3(qr, rp) : qr2 == longest ? cross3(rp, pq) : cross3(pq, qr);
  real area = length_of(normal), side = square_root(longest);
  if (area <= side * (noise + R(16.0) * ROUNDING * side)) return make_vec3(R(0.0), R(0.0), R(0.0));
  return scale(normal, R(1.0) / area);
}

SHARED void add_face(polytope *hull, uint p, uint q, uint r, real noise)
{
  int f = hull->faces;
  vec3 normal = triangle_normal(hull->w[p], hull->w[q], hull->w[r], noise);
  hull->normal[f] = normal;
  hull->distance[f] = length_squared(normal) > R(0.0) ? dot3(normal, hull->w[p]) : EPA_FAR;
  hull->corners[f] = p | q << 8u | r << 16u;
  hull->faces = f + 1;
}

SHARED uint add_vertex(polytope *hull, vec3 point)
{
  int at = hull->vertices;
  hull->w[at] = point;
  hull->vertices = at + 1;
  return (uint)at;
}

SHARED void swap_faces(polytope *hull, int f, int g)
{
  vec3 normal = hull->normal[f];
  real distance = hull->distance[f];
  uint corners = hull->corners[f];
  hull->normal[f] = hull->normal[g];
  hull->distance[f] = hull->distance[g];
  hull->corners[f] = hull->corners[g];
  hull->normal[g] = normal;
  hull->distance[g] = distance;
  hull->corners[g] = corners;
}

SHARED mask has_edge(const polytope *hull, int begin, int end, uint from, uint to)
{
  for (int f = begin; f < end; ++f)
    for (uint k = 0u; k < 3u; ++k)
      if (corner_of(hull->corners[f], k) == from && corner_of(hull->corners[f], (k + 1u) % 3u) == to) return 1;
  return 0;
}

/* Grows the polytope by a point beyond its face `nearest`. False if there is no room. */
SHARED mask expand(polytope *hull, int nearest, vec3 point, real noise)
{
  if (hull->vertices == EPA_VERTICES) return 0;
  int kept = hull->faces - 1;
  swap_faces(hull, nearest, kept);
  for (int f = 0; f < kept;) {
    if (dot3(hull->normal[f], point) > hull->distance[f] + noise) swap_faces(hull, f, --kept);
    else ++f;
  }
  uint tip = add_vertex(hull, point);
  int end = hull->faces;
  for (int f = kept; f < end; ++f)
    for (uint k = 0u; k < 3u; ++k) {
      uint from = corner_of(hull->corners[f], k), to = corner_of(hull->corners[f], (k + 1u) % 3u);
      if (has_edge(hull, kept, end, to, from)) continue;
      if (hull->faces == EPA_FACES) return 0;
      add_face(hull, from, to, tip, noise);
    }
  int added = hull->faces - end;
  hull->faces = kept;
  for (int f = 0; f < added; ++f) {
    swap_faces(hull, kept + f, end + f);
    hull->faces = hull->faces + 1;
  }
  return hull->faces > 0;
}

/* Of the faces not tried yet; -1 if there is none. */
SHARED int nearest_face(const polytope *hull)
{
  int nearest = -1;
  real least = EPA_FAR;
  for (int f = 0; f < hull->faces; ++f)
    if (hull->distance[f] < least && (hull->corners[f] & EPA_TRIED) == 0u) {
      least = hull->distance[f];
      nearest = f;
    }
  return nearest;
}

SHARED mask has_vertex(const polytope *hull, vec3 w)
{
  for (int k = 0; k < hull->vertices; ++k)
    if (hull->w[k].x == w.x && hull->w[k].y == w.y && hull->w[k].z == w.z) return 1;
  return 0;
}

/* The supports along a direction and against it. */
typedef struct {
  vec3 ahead, behind;
} difference_span;

SHARED difference_span span_of_difference(const convex *a, const convex *b, vec3 direction)
{
  difference_span span;
  span.ahead = span.behind = make_vec3(R(0.0), R(0.0), R(0.0));
  for (int end = 0; end < 2; ++end) {
    span.ahead = span.behind;
    span.behind = support_of_difference(a, b, end == 0 ? direction : negate(direction));
  }
  return span;
}

/* The farther of the two, measured from a point. */
SHARED vec3 farther_support(const convex *a, const convex *b, vec3 direction, vec3 from)
{
  difference_span span = span_of_difference(a, b, direction);
  return dot3(subtract(from, span.behind), direction) > dot3(subtract(span.ahead, from), direction) ? span.behind
                                                                                                    : span.ahead;
}

SHARED vec3 unit_or(vec3 v, vec3 otherwise)
{
  real length = length_of(v);
  if (length <= R(1e-18)) return otherwise;
  return scale(v, R(1.0) / length);
}

/* Points of a - b far apart, as many as its dimension and one more. Returns how many; spans are compared with
 * `flat`. */
SHARED int spread_points(vec3 *point, const convex *a, const convex *b, real flat)
{
  real widest = R(-1.0);
  for (int k = 0; k < 3; ++k) {
    vec3 direction = make_vec3(k == 0 ? R(1.0) : R(0.0), k == 1 ? R(1.0) : R(0.0), k == 2 ? R(1.0) : R(0.0));
    difference_span span = span_of_difference(a, b, direction);
    real width = length_of(subtract(span.ahead, span.behind));
    if (width <= widest) continue;
    widest = width;
    point[0] = span.behind;
    point[1] = span.ahead;
  }
  if (widest <= flat) return 1;
  vec3 line = scale(subtract(point[1], point[0]), R(1.0) / widest);
  tangents across = tangents_of(line);
  mask wide = 0;
  for (int k = 0; k < 2 && !wide; ++k) {
    vec3 direction = k == 0 ? across.first : across.second;
    point[2] = farther_support(a, b, direction, point[0]);
    wide = magnitude(dot3(subtract(point[2], point[0]), direction)) > flat;
  }
  if (!wide) return 2;
  vec3 normal = unit_or(cross3(line, subtract(point[2], point[0])), across.second);
  point[3] = farther_support(a, b, normal, point[0]);
  return magnitude(dot3(subtract(point[3], point[0]), normal)) <= flat ? 3 : 4;
}

SHARED core_contact contact_along(const convex *a, const convex *b, vec3 normal)
{
  core_contact contact = {normal, gap_along(a, b, normal)};
  return contact;
}

/* a - b is a point, a line or a plane: its normals are known. Two shapes with a point in common part along `up`. */
SHARED core_contact flat_contact(const vec3 *point, int points, const convex *a, const convex *b, vec3 up)
{
  vec3 normal = up;
  if (points > 1) {
    vec3 line = unit_or(subtract(point[1], point[0]), up);
    vec3 sideways = subtract(up, scale(line, dot3(up, line)));
    normal = length_squared(sideways) > R(1e-4) ? unit_or(sideways, up) : tangents_of(line).first;
    if (points > 2) normal = unit_or(cross3(line, subtract(point[2], point[0])), normal);
  }
  difference_span span = span_of_difference(a, b, normal);
  core_contact forward = {normal, -dot3(span.ahead, normal)}, backward = {negate(normal), dot3(span.behind, normal)};
  return backward.gap > forward.gap ? backward : forward;
}

SHARED void start_polytope(polytope *hull, const vec3 *point, real noise)
{
  hull->vertices = 0;
  hull->faces = 0;
  for (int k = 0; k < 4; ++k) add_vertex(hull, point[k]);
  vec3 normal = cross3(subtract(point[1], point[0]), subtract(point[2], point[0]));
  mask above = dot3(normal, subtract(point[3], point[0])) > R(0.0);
  uint q = above ? 2u : 1u, r = above ? 1u : 2u;
  add_face(hull, 0u, q, r, noise);
  add_face(hull, 0u, r, 3u, noise);
  add_face(hull, r, q, 3u, noise);
  add_face(hull, q, 0u, 3u, noise);
}

/* Until no face is left that could lie nearer than the best support found. A face beyond which nothing lies is set
 * aside, not the end of it all: by rounding it may be one that is hardly a face. */
SHARED void expand_to_depth(epa_result *result, polytope *hull, const convex *a, const convex *b, real tolerance,
                            real noise)
{
  real enough = tolerance + R(2.0) * ROUNDING * bounding_radius_of(b);
  result->contact = contact_along(a, b, hull->normal[0]);
  for (int round = 0; round < EPA_ROUNDS; ++round) {
    int nearest = nearest_face(hull);
    if (nearest < 0) break;
    real distance = hull->distance[nearest], best = -result->contact.gap;
    result->error = maximum(best - distance, R(0.0));
    if (distance >= best - enough - R(16.0) * ROUNDING * magnitude(best)) break;
    vec3 normal = hull->normal[nearest];
    vec3 next = support_of_difference(a, b, normal);
    real depth = dot3(next, normal);
    if (depth < best) {
      result->contact.normal = normal;
      result->contact.gap = -depth;
    }
    if (has_vertex(hull, next)) hull->corners[nearest] |= EPA_TRIED;
    else if (!expand(hull, nearest, next, noise)) break;
  }
}

/* up: where to part shapes that have no better direction. tolerance: how much deeper than the least depth the answer
 * may be. */
SHARED epa_result penetration_by_expansion(const convex *a, const convex *b, vec3 up, real tolerance)
{
  real size = bounding_radius_of(a) + bounding_radius_of(b), noise = R(4.0) * ROUNDING * size;
  vec3 point[4];
  epa_result result;
  result.error = R(0.0);
  int points = spread_points(point, a, b, R(64.0) * ROUNDING * size);
  if (points < 4) {
    result.contact = flat_contact(point, points, a, b, up);
    return result;
  }
  polytope hull;
  start_polytope(&hull, point, noise);
  expand_to_depth(&result, &hull, a, b, tolerance, noise);
  return result;
}

#endif
