/* face_clip.h - clips a face of one box against a face of another one, seen along the normal of the latter.
 *
 *            +-----------+            The reference face is a rectangle, the incident face a
 *            | rectangle |            parallelogram above it. Every corner of their overlap is
 *        .---x-----.     |            an end of a side of the parallelogram cut to the
 *         \  |      \    |            rectangle (x, 8 at most), or a corner of the rectangle
 *          \ x-------x---+            inside the parallelogram (4 at most).
 *           `---------`
 *
 * These 12 candidates replace the loops of Sutherland and Hodgman's clipping (CACM 17(1), 1974), so that all lanes do
 * the same work. Candidates may coincide; the reduction keeps one of them (point_reduction.h).
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FACE_CLIP_H
#define TANDEM_SHARED_NARROWPHASE_FACE_CLIP_H

#include "shared/math.h"

#define CLIP_CANDIDATES 12

typedef struct {
  real u, v;       /* in the plane of the reference face */
  real separation; /* above it */
  mask valid;
} clip_point;

typedef struct {
  real low_u, high_u, low_v, high_v;
} clip_rectangle;

/* The points center + s p + t q with |s| <= 1 and |t| <= 1. x and y lie in the reference plane, z is the height. */
typedef struct {
  vec3 center, p, q;
  real length_p, length_q;
} clip_face;

/* 1 / x, with a large finite value where x is nearly 0. */
SHARED real guarded_inverse(real x, real tiny)
{
  return R(1.0) / choose(magnitude(x) < tiny, choose(x < R(0.0), -tiny, tiny), x);
}

SHARED clip_point point_on_side(vec3 middle, vec3 extent, real t, clip_rectangle inside, mask valid)
{
  clip_point point;
  point.u = clamped(middle.x + extent.x * t, inside.low_u, inside.high_u);
  point.v = clamped(middle.y + extent.y * t, inside.low_v, inside.high_v);
  point.separation = middle.z + extent.z * t;
  point.valid = valid;
  return point;
}

/* Cuts the side middle + t extent, |t| <= 1, to the rectangle widened by slack (Liang and Barsky, 1984). */
SHARED void clip_side(clip_point *first, vec3 middle, vec3 extent, real inverse_u, real inverse_v,
                      clip_rectangle inside, real slack)
{
  real u_low = (inside.low_u - slack - middle.x) * inverse_u, u_high = (inside.high_u + slack - middle.x) * inverse_u;
  real v_low = (inside.low_v - slack - middle.y) * inverse_v, v_high = (inside.high_v + slack - middle.y) * inverse_v;
  real enter = maximum(maximum(minimum(u_low, u_high), minimum(v_low, v_high)), R(-1.0));
  real leave = minimum(minimum(maximum(u_low, u_high), maximum(v_low, v_high)), R(1.0));
  first[0] = point_on_side(middle, extent, enter, inside, enter <= leave);
  first[1] = point_on_side(middle, extent, leave, inside, enter <= leave);
}

/* The corner of the rectangle, lifted to the plane of the incident face. area: of p x q in the reference plane. */
SHARED clip_point corner_under(clip_face face, real area, real inverse_area, real u, real v, real slack)
{
  real from_u = u - face.center.x, from_v = v - face.center.y;
  real s = from_u * face.q.y - from_v * face.q.x, t = from_v * face.p.x - from_u * face.p.y;
  clip_point point;
  mask within_p = magnitude(s) <= area + slack * face.length_q, within_q = magnitude(t) <= area + slack * face.length_p;
  point.valid = within_p & within_q;
  s = clamped(s * inverse_area, R(-1.0), R(1.0));
  t = clamped(t * inverse_area, R(-1.0), R(1.0));
  point.u = u;
  point.v = v;
  point.separation = face.center.z + face.p.z * s + face.q.z * t;
  return point;
}

SHARED void clip_face_by_rectangle(clip_point *candidate, clip_face face, clip_rectangle inside, real slack)
{
  real tiny = slack * R(1e-4);
  real p_u = guarded_inverse(face.p.x, tiny), p_v = guarded_inverse(face.p.y, tiny);
  real q_u = guarded_inverse(face.q.x, tiny), q_v = guarded_inverse(face.q.y, tiny);
  clip_side(candidate, subtract(face.center, face.q), face.p, p_u, p_v, inside, slack);
  clip_side(candidate + 2, add(face.center, face.q), face.p, p_u, p_v, inside, slack);
  clip_side(candidate + 4, subtract(face.center, face.p), face.q, q_u, q_v, inside, slack);
  clip_side(candidate + 6, add(face.center, face.p), face.q, q_u, q_v, inside, slack);

  real area = face.p.x * face.q.y - face.p.y * face.q.x, size = magnitude(area);
  real inverse_area = guarded_inverse(area, tiny * tiny);
  candidate[8] = corner_under(face, size, inverse_area, inside.low_u, inside.low_v, slack);
  candidate[9] = corner_under(face, size, inverse_area, inside.high_u, inside.low_v, slack);
  candidate[10] = corner_under(face, size, inverse_area, inside.low_u, inside.high_v, slack);
  candidate[11] = corner_under(face, size, inverse_area, inside.high_u, inside.high_v, slack);
}

#endif
