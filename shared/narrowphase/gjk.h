/* gjk.h - the distance and the closest points of two convex cores, or the result that they overlap.
 *
 * The algorithm is that of Gilbert, Johnson and Keerthi (1988): a simplex of points of a - b moves toward the origin.
 * Each new point is the support point of a - b against the point v of the simplex that is nearest to the origin.
 *
 *        w2 ---- w1           v: nearest point of the simplex; |v| is an upper bound of the distance
 *          \    /             w . v / |v|: the gap along v, a lower bound
 *           \v /              The iteration ends where both agree, where nothing new is found, or after GJK_ROUNDS. The
 *            \/               answer is the largest gap found and its direction, a true lower bound in every case.
 *            o origin
 *
 * The nearest point of a simplex is found by the Voronoi regions of its features (Ericson, "Real-Time Collision
 * Detection", 2005, section 9.5):
 *
 *             \ a /              The origin lies in the Voronoi region of a vertex (a b c), an edge (ab bc ca) or the
 *              \./               face (abc), and the nearest point lies on that feature. The points of the simplex that
 *         ab   / \   ca          do not belong to the feature are removed (keep_carriers). The Voronoi regions meet at
 *             /   \              lines through the vertices that are perpendicular to the edges.
 *       `.   / abc \   .'
 *     b   `./_______\.'   c
 *          |   bc    |
 *
 * The regions are computed from differences of the points, never from determinants of their coordinates, which cancel
 * where tiny and huge coordinates meet. Every face that may have the origin outside is tried and the nearest one wins,
 * so a flat tetrahedron needs no special case. That is the aim of Montanari, Petrinic, Barbieri, "Improving the GJK
 * algorithm for faster and more reliable distance queries between convex objects", ACM TOG 36(3), 2017, too.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_GJK_H
#define TANDEM_SHARED_NARROWPHASE_GJK_H

#include "shared/narrowphase/closest_segments.h"
#include "shared/narrowphase/convex.h"

#define GJK_ROUNDS 48
/* The number of rounds that may pass without v becoming shorter. */
#define GJK_STALLS 4

/* A point of a - b, and the point of b that it comes from. */
typedef struct {
  vec3 w, b;
} difference_point;

typedef struct {
  difference_point point[4];
  real weight[4]; /* barycentric coordinates of the nearest point */
  int count;
} simplex;

/* The point of some feature of a simplex nearest to the origin. */
typedef struct {
  vec3 v;
  real squared; /* square of the length of v */
  real weight[4];
} nearest_point;

typedef struct {
  mask overlapping;     /* also set if rounding hides whether they are apart; there are then no closest points */
  core_contact contact; /* of the largest gap found */
  vec3 on_a, on_b;      /* the closest points */
  simplex last;
} gjk_result;

SHARED nearest_point nearest_of_vertex(const simplex *s, int i)
{
  nearest_point near;
  near.v = s->point[i].w;
  near.squared = length_squared(near.v);
  for (int k = 0; k < 4; ++k) near.weight[k] = k == i ? R(1.0) : R(0.0);
  return near;
}
SHARED nearest_point nearer_of(nearest_point p, nearest_point q) { return q.squared < p.squared ? q : p; }

SHARED nearest_point nearest_of_edge(const simplex *s, int i, int j)
{
  vec3 from = s->point[i].w, edge = subtract(s->point[j].w, from);
  real along = length_squared(edge), t = -dot3(from, edge);
  if (t <= R(0.0) || along <= R(0.0)) return nearest_of_vertex(s, i);
  if (t >= along) return nearest_of_vertex(s, j);
  t = t / along;
  vec3 v = add_scaled(from, edge, t);
  /* The remainder that rounding left along the edge is removed, because v must be perpendicular to the edge. */
  real rest = dot3(v, edge) / along;
  nearest_point near;
  near.v = add_scaled(v, edge, -rest);
  near.squared = length_squared(near.v);
  for (int k = 0; k < 4; ++k) near.weight[k] = R(0.0);
  near.weight[i] = R(1.0) - (t - rest);
  near.weight[j] = t - rest;
  return near;
}

SHARED nearest_point nearest_of_triangle(const simplex *s, int i, int j, int k)
{
  vec3 a = s->point[i].w, b = s->point[j].w, c = s->point[k].w;
  vec3 ab = subtract(b, a), ac = subtract(c, a), bc = subtract(c, b);
  vec3 normal = cross3(ab, ac);
  real squared = length_squared(normal), flat = R(16.0) * ROUNDING;
  mask degenerate = squared <= flat * flat * length_squared(ab) * length_squared(ac);
  /* Twice the areas of the triangles of the origin's projection with each side, times the length of the normal. */
  real of_c = dot3(normal, cross3(a, ab)), of_b = dot3(normal, cross3(ac, a)), of_a = dot3(normal, cross3(b, bc));
  if (!degenerate && of_a > R(0.0) && of_b > R(0.0) && of_c > R(0.0)) {
    nearest_point near;
    real sum = of_a + of_b + of_c;
    near.v = scale(normal, dot3(normal, a) / squared);
    near.squared = length_squared(near.v);
    for (int n = 0; n < 4; ++n) near.weight[n] = R(0.0);
    near.weight[i] = of_a / sum;
    near.weight[j] = of_b / sum;
    near.weight[k] = of_c / sum;
    return near;
  }
  nearest_point best;
  for (int side = 0; side < 3; ++side) {
    if (side > 0 && !degenerate && (side == 1 ? of_b : of_a) > R(0.0)) continue;
    nearest_point near = nearest_of_edge(s, side < 2 ? i : j, side == 0 ? j : k);
    best = side > 0 ? nearer_of(best, near) : near;
  }
  return best;
}

/* Whether the origin may lie outside face i j k. The inner side of the face is that of point l. */
SHARED mask outside_face(const simplex *s, int i, int j, int k, int l, real size)
{
  vec3 a = s->point[i].w;
  vec3 normal = cross3(subtract(s->point[j].w, a), subtract(s->point[k].w, a));
  real inner_side = dot3(normal, subtract(s->point[l].w, a)), side = -dot3(normal, a);
  real noise = R(8.0) * ROUNDING * size * length_of(normal);
  if (magnitude(inner_side) <= noise) return 1;
  return inner_side > R(0.0) ? side <= R(0.0) : side >= R(0.0);
}

/* The nearest point of a triangle or of the faces of a tetrahedron; squared < 0 if a tetrahedron contains the origin.
 * size: of the coordinates. Each function is called from one place here, because device compilers inline every call. */
SHARED nearest_point nearest_of_faces(const simplex *s, real size)
{
  nearest_point best = nearest_of_vertex(s, 0);
  mask outside = 0;
  for (int l = s->count == 3 ? 3 : 0; l < 4; ++l) {
    int i = l == 0 ? 1 : 0, j = l <= 1 ? 2 : 1, k = l <= 2 ? 3 : 2;
    if (s->count == 4 && !outside_face(s, i, j, k, l, size)) continue;
    nearest_point near = nearest_of_triangle(s, i, j, k);
    best = outside ? nearer_of(best, near) : near;
    outside = 1;
  }
  if (!outside) best.squared = R(-1.0);
  return best;
}

SHARED nearest_point nearest_of_simplex(const simplex *s, real size)
{
  if (s->count == 1) return nearest_of_vertex(s, 0);
  return s->count == 2 ? nearest_of_edge(s, 0, 1) : nearest_of_faces(s, size);
}

/* Removes the points whose weight in the nearest point is 0. */
SHARED void keep_carriers(simplex *s, const nearest_point *near)
{
  int kept = 0;
  for (int k = 0; k < s->count; ++k)
    if (near->weight[k] > R(0.0)) {
      s->point[kept] = s->point[k];
      s->weight[kept] = near->weight[k];
      ++kept;
    }
  s->count = kept;
}

SHARED mask has_point(const simplex *s, vec3 w)
{
  for (int k = 0; k < s->count; ++k)
    if (s->point[k].w.x == w.x && s->point[k].w.y == w.y && s->point[k].w.z == w.z) return 1;
  return 0;
}
SHARED real size_of_simplex(const simplex *s)
{
  real squared = R(0.0);
  for (int k = 0; k < s->count; ++k) squared = maximum(squared, length_squared(s->point[k].w));
  return square_root(squared);
}

SHARED vec3 carried_point(const simplex *s)
{
  vec3 point = scale(s->point[0].b, s->weight[0]);
  for (int k = 1; k < s->count; ++k) point = add_scaled(point, s->point[k].b, s->weight[k]);
  return point;
}

/* The accuracy that a caller needs. Beyond the limit, any lower bound above it is enough. Below the limit, the error
 * may be a share of the distance between the cores less their radii. */
typedef struct {
  real limit, share, radii;
} gap_wanted;

SHARED gap_wanted whole_gap(real limit)
{
  gap_wanted wanted = {limit, R(0.0), R(0.0)};
  return wanted;
}

/* The state between two rounds. squared is the square of `distance` for the last simplex, or 0 before there is one. */
typedef struct {
  vec3 v; /* the nearest point of the simplex; at first, and after a restart, a direction */
  real distance, squared;
  int stalled; /* rounds so far in which v grew no shorter */
  mask restarted;
} gjk_walk;

SHARED gjk_walk begin_walk(vec3 v)
{
  gjk_walk walk = {v, length_of(v), R(0.0), 0, 0};
  if (walk.distance <= R(0.0)) {
    walk.distance = R(1.0);
    walk.v = make_vec3(R(1.0), R(0.0), R(0.0));
  }
  return walk;
}

SHARED difference_point difference_point_along(const convex *a, const convex *b, vec3 direction)
{
  difference_point point;
  point.b = support_of(b, negate(direction));
  point.w = subtract(support_of(a, direction), point.b);
  return point;
}

/* Whether the iteration may end: both bounds agree to the accuracy wanted, the gap is beyond the limit, or the support
 * point is already in the simplex. */
SHARED mask is_known_well(const simplex *s, gap_wanted wanted, real distance, real gap, vec3 w)
{
  if (s->count == 0) return 0;
  real rounding = ROUNDING * (R(16.0) * distance + R(4.0) * size_of_simplex(s));
  real unknown = wanted.share * maximum(distance - wanted.radii, R(0.0));
  return distance - gap <= rounding + unknown || gap > wanted.limit || has_point(s, w);
}

enum { SIMPLEX_IS_NEARER, SIMPLEX_HOLDS_ORIGIN, SIMPLEX_IS_SLIVER };

/* Classifies the simplex after a point was added. points: their number before; gap: the largest gap found. */
SHARED int judge_simplex(gjk_walk *walk, real near_squared, int points, real gap, real noise)
{
  /* A gap proves that no simplex contains the origin. One that seems to is a sliver whose sides rounding has turned. */
  if (near_squared <= noise * noise) return points > 0 && gap > noise ? SIMPLEX_IS_SLIVER : SIMPLEX_HOLDS_ORIGIN;
  if (points == 0 || !(near_squared >= walk->squared)) return SIMPLEX_IS_NEARER;
  /* If v turns by a small angle, its length shrinks by the square of that angle. Rounding hides this while the gap
   * still grows. */
  walk->stalled = walk->stalled + 1;
  if (walk->stalled > GJK_STALLS || near_squared > walk->squared * (R(1.0) + R(32.0) * ROUNDING))
    return SIMPLEX_IS_SLIVER;
  return SIMPLEX_IS_NEARER;
}

/* Restarts the iteration once from the best direction found, after a sliver ended it. False if that would gain
 * nothing. */
SHARED mask restart_walk(gjk_walk *walk, simplex *s, const core_contact *best, int round, real size)
{
  if (walk->restarted || round + 4 > GJK_ROUNDS) return 0;
  if (walk->distance - best->gap <= R(64.0) * ROUNDING * size) return 0;
  walk->restarted = 1;
  walk->stalled = s->count = 0;
  walk->v = negate(best->normal);
  walk->distance = R(1.0);
  return 1;
}

SHARED void go_to_nearest(gjk_walk *walk, simplex *s, const nearest_point *near)
{
  keep_carriers(s, near);
  walk->v = near->v;
  walk->squared = near->squared;
  walk->distance = square_root(near->squared);
}

/* Adds one point to the simplex; false if the iteration ends. */
SHARED mask walk_round(const convex *a, const convex *b, gap_wanted wanted, int round, gjk_walk *walk,
                       gjk_result *result)
{
  simplex *s = &result->last;
  vec3 direction = scale(walk->v, R(-1.0) / walk->distance);
  difference_point next = difference_point_along(a, b, direction);
  real gap = -dot3(next.w, direction);
  if (gap > result->contact.gap) {
    result->contact.gap = gap;
    result->contact.normal = direction;
  }
  if (is_known_well(s, wanted, walk->distance, gap, next.w)) return 0;
  simplex before = *s;
  s->point[s->count] = next;
  s->count = s->count + 1;
  real size = size_of_simplex(s), noise = R(4.0) * ROUNDING * size;
  nearest_point near = nearest_of_simplex(s, size);
  int verdict = judge_simplex(walk, near.squared, before.count, result->contact.gap, noise);
  result->overlapping = verdict == SIMPLEX_HOLDS_ORIGIN;
  if (verdict == SIMPLEX_IS_NEARER) go_to_nearest(walk, s, &near);
  if (verdict == SIMPLEX_IS_SLIVER) *s = before;
  return verdict == SIMPLEX_IS_NEARER ||
         (verdict == SIMPLEX_IS_SLIVER && restart_walk(walk, s, &result->contact, round, size));
}

/* A tapered capsule has another core. */
SHARED mask has_segment(const convex *shape)
{
  return shape->kind == (uint)SHAPE_SPHERE || (is_capsule(shape) && shape->size.x == shape->size.z);
}

/* Half of the segment, from its middle to the end at the top; 0 for a sphere. */
SHARED vec3 half_segment(const convex *shape)
{
  return from_shape_axes(shape, make_vec3(R(0.0), is_capsule(shape) ? shape->size.y : R(0.0), R(0.0)));
}

/* The closest points of two segments; false if these are too near each other for a normal between them, or if rounding
 * has moved them along nearly parallel segments. */
SHARED mask closest_points_of_segments(const convex *a, const convex *b, gjk_result *result)
{
  segment_points p = closest_of_segments(a->center, half_segment(a), b->center, half_segment(b));
  vec3 between = subtract(p.on_b, p.on_a);
  real distance = length_of(between), noise = R(8.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b));
  if (!(distance > noise)) return 0;
  result->on_a = p.on_a;
  result->on_b = p.on_b;
  result->contact.normal = scale(between, R(1.0) / distance);
  result->contact.gap = gap_along(a, b, result->contact.normal);
  return distance - result->contact.gap <= noise;
}

/* v: a first guess of the direction from b to a. */
SHARED gjk_result closest_points_from(const convex *a, const convex *b, gap_wanted wanted, vec3 v)
{
  gjk_result result;
  result.last.count = 0;
  result.overlapping = 0;
  if (MAY_OCCUR(ROUND) && has_segment(a) && has_segment(b) && closest_points_of_segments(a, b, &result)) return result;
  result.contact.gap = R(-1e30);
  gjk_walk walk = begin_walk(v);
  for (int round = 0; round < GJK_ROUNDS; ++round)
    if (!walk_round(a, b, wanted, round, &walk, &result)) break;
  if (result.overlapping) return result;
  result.on_b = carried_point(&result.last);
  result.on_a = add(result.on_b, walk.v);
  return result;
}
SHARED gjk_result closest_points(const convex *a, const convex *b, real limit)
{
  return closest_points_from(a, b, whole_gap(limit), subtract(a->center, b->center));
}

#endif
