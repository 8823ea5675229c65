/* polygon_clip.h - clips two supporting features against each other, seen along the contact normal. The result is a
 * stream of points, not a polygon.
 *
 *            +-----------+          Both features are flat outlines (u, v) with a height along the normal. Every corner
 *            | reference |          of their overlap is either an end of an edge of the moving outline that was cut by
 *        .---x-----.     |          all sides of the reference (x; M. Cyrus, J. Beck, "Generalized two- and
 *         \  |      \    |          three-dimensional clipping", 1978), or a corner of the reference inside the
 *          \ x-------x---+          moving outline (+).
 *           `---------`
 *
 * The points are not stored in an array: reduce_step() receives one after the other. The number of corners of an
 * outline is therefore not limited.
 *
 * A segment is an outline of one edge. Between two segments the stream holds the ends of the part along which they are
 * parallel and overlap, or the one point where they cross.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_POLYGON_CLIP_H
#define TANDEM_SHARED_NARROWPHASE_POLYGON_CLIP_H

#include "shared/narrowphase/contact_points.h"
#include "shared/narrowphase/support_face.h"

#define OUTLINE_KEPT 8u
/* Sine of the angle below which two segments count as parallel. */
#define SEGMENTS_PARALLEL R(0.03)

/* The axes of the contact: two in its plane, and its normal. */
typedef struct {
  vec3 u, v, normal;
} contact_axes;

SHARED vec3 in_contact_axes(const contact_axes *axes, vec3 p)
{
  return make_vec3(dot3(axes->u, p), dot3(axes->v, p), dot3(axes->normal, p));
}

/* A supporting feature in the axes of the contact: x and y are its outline, z is its height. The first corners are
 * stored, the others are computed whenever they are needed. */
typedef struct {
  const convex *shape;
  const support_face *face;
  const contact_axes *axes;
  uint corners;
  real turn;             /* 1: the outline runs counter-clockwise; -1: clockwise */
  real slope_u, slope_v; /* of the height */
  vec3 kept[OUTLINE_KEPT];
  real side[OUTLINE_KEPT]; /* of a reference: the length of the side that ends at the corner */
} outline;

SHARED vec3 outline_corner(const outline *o, uint k)
{
  return k < OUTLINE_KEPT ? o->kept[k] : in_contact_axes(o->axes, face_corner(o->shape, o->face, k));
}
SHARED void make_outline(outline *o, const convex *shape, const support_face *face, const contact_axes *axes)
{
  o->shape = shape;
  o->face = face;
  o->axes = axes;
  o->corners = face->corners;
  vec3 normal = in_contact_axes(axes, face->normal);
  o->turn = normal.z < R(0.0) ? R(-1.0) : R(1.0);
  o->slope_u = face->corners > 2u ? -normal.x / normal.z : R(0.0);
  o->slope_v = face->corners > 2u ? -normal.y / normal.z : R(0.0);
  for (uint k = 0u; k < OUTLINE_KEPT; ++k)
    if (k < face->corners) o->kept[k] = in_contact_axes(axes, face_corner(shape, face, k));
}

SHARED real length_of_side(vec3 side) { return square_root(side.x * side.x + side.y * side.y); }
SHARED void measure_sides(outline *o)
{
  vec3 from = outline_corner(o, o->corners - 1u);
  for (uint k = 0u; k < OUTLINE_KEPT && k < o->corners; ++k) {
    o->side[k] = length_of_side(subtract(o->kept[k], from));
    from = o->kept[k];
  }
}

/* The height of a feature above the point (u, v). */
SHARED real height_of(const outline *o, real u, real v)
{
  vec3 from = o->kept[0];
  if (o->corners > 2u) return from.z + o->slope_u * (u - from.x) + o->slope_v * (v - from.y);
  if (o->corners == 1u) return from.z;
  vec3 edge = subtract(o->kept[1], from);
  real squared = edge.x * edge.x + edge.y * edge.y;
  if (squared <= R(0.0)) return from.z;
  return from.z + edge.z * clamped(((u - from.x) * edge.x + (v - from.y) * edge.y) / squared, R(0.0), R(1.0));
}

typedef struct {
  const outline *reference, *moving;
  real sense; /* 1: the moving feature is that of b */
  real radii; /* of both cores */
  real reach; /* points with a larger separation are dropped */
  real slack; /* rounding error of a corner */
} clipping;

SHARED clip_point clipped_point(const clipping *clip, vec3 at, real height_of_other, real sense)
{
  clip_point point;
  point.u = at.x;
  point.v = at.y;
  point.separation = (at.z - height_of_other) * sense - clip->radii;
  point.valid = point.separation < clip->reach;
  return point;
}

/* Cuts the part enter..leave of p + t edge to the inner side of the line from + s side. */
SHARED void cut_by_side(real *enter, real *leave, vec3 p, vec3 edge, vec3 from, vec3 side, real length, real turn,
                        real slack)
{
  real inside = (side.x * (p.y - from.y) - side.y * (p.x - from.x)) * turn + slack * length;
  real rate = (side.x * edge.y - side.y * edge.x) * turn;
  real parallel = ROUNDING * length * (magnitude(edge.x) + magnitude(edge.y));
  if (magnitude(rate) <= parallel) {
    if (inside < R(0.0)) *leave = R(-1.0);
  } else if (rate > R(0.0)) {
    *enter = maximum(*enter, -inside / rate);
  } else {
    *leave = minimum(*leave, -inside / rate);
  }
}

/* The ends of the remaining part of an edge of the moving feature. */
SHARED void stream_segment(reduction *r, const clipping *clip, vec3 entry, vec3 exit)
{
  for (int end = 0; end < 2; ++end) {
    vec3 at = end == 0 ? entry : exit;
    reduce_step(r, clipped_point(clip, at, height_of(clip->reference, at.x, at.y), clip->sense));
  }
}

SHARED void stream_moving_edge(reduction *r, const clipping *clip, vec3 p, vec3 q)
{
  const outline *reference = clip->reference;
  vec3 edge = subtract(q, p), from = outline_corner(reference, reference->corners - 1u);
  real enter = R(0.0), leave = R(1.0);
  for (uint k = 0u; k < reference->corners && enter <= leave; ++k) {
    vec3 to = outline_corner(reference, k);
    vec3 side = subtract(to, from);
    cut_by_side(&enter, &leave, p, edge, from, side, k < OUTLINE_KEPT ? reference->side[k] : length_of_side(side),
                reference->turn, clip->slack);
    from = to;
  }
  if (enter > leave) return;
  stream_segment(r, clip, add_scaled(p, edge, enter), leave >= R(1.0) ? q : add_scaled(p, edge, leave));
}

SHARED mask within_outline(const outline *o, vec3 p, real slack)
{
  vec3 from = outline_corner(o, o->corners - 1u);
  for (uint k = 0u; k < o->corners; ++k) {
    vec3 to = outline_corner(o, k), side = subtract(to, from);
    real inside = (side.x * (p.y - from.y) - side.y * (p.x - from.x)) * o->turn;
    if (inside < R(0.0) && inside * inside > slack * slack * (side.x * side.x + side.y * side.y)) return 0;
    from = to;
  }
  return 1;
}

SHARED void stream_reference_corners(reduction *r, const clipping *clip)
{
  for (uint k = 0u; k < clip->reference->corners; ++k) {
    vec3 corner = outline_corner(clip->reference, k);
    if (within_outline(clip->moving, corner, clip->slack))
      reduce_step(r, clipped_point(clip, corner, height_of(clip->moving, corner.x, corner.y), -clip->sense));
  }
}

/* Parallel segments: the part of the moving one between the ends of the other one. Other segments: the point where they
 * cross, if they do. */
SHARED void stream_segments(reduction *r, const clipping *clip)
{
  vec3 p = clip->moving->kept[0], edge = subtract(clip->moving->kept[1], p);
  vec3 q = clip->reference->kept[0], side = subtract(clip->reference->kept[1], q);
  real across = edge.x * side.y - edge.y * side.x, along = edge.x * side.x + edge.y * side.y;
  real from_p = (q.x - p.x) * side.x + (q.y - p.y) * side.y, square = side.x * side.x + side.y * side.y;
  real enter = R(0.0), leave = R(1.0);
  if (square <= R(0.0)) return;
  if (magnitude(across) > SEGMENTS_PARALLEL * magnitude(along)) {
    real t = ((q.x - p.x) * side.y - (q.y - p.y) * side.x) / across;
    enter = leave = clamped(t, R(0.0), R(1.0));
    real s = (enter * along - from_p) / square;
    if (s < R(-0.01) || s > R(1.01) || t < R(-0.01) || t > R(1.01)) return;
  } else {
    real first = from_p / along, second = (from_p + square) / along;
    enter = maximum(enter, minimum(first, second));
    leave = minimum(leave, maximum(first, second));
    if (enter > leave) return;
  }
  stream_segment(r, clip, add_scaled(p, edge, enter), add_scaled(p, edge, leave));
}

/* The whole stream, always in the same order. Features of one point have an empty stream. */
SHARED void stream_overlap(reduction *r, const clipping *clip)
{
  uint moving = clip->moving->corners;
  if (moving == 1u || clip->reference->corners == 1u) return;
  if (clip->reference->corners == 2u) {
    stream_segments(r, clip);
    return;
  }
  mask segment = moving == 2u;
  vec3 from = outline_corner(clip->moving, segment ? 0u : moving - 1u);
  for (uint k = segment ? 1u : 0u; k < moving; ++k) {
    vec3 to = outline_corner(clip->moving, k);
    stream_moving_edge(r, clip, from, to);
    from = to;
  }
  if (!segment) stream_reference_corners(r, clip);
}

#endif
