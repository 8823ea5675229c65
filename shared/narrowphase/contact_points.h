/* contact_points.h - reduces a stream of contact points of any length to four: points that span nearly the whole
 * contact area, and the deepest one.
 *
 * It makes the choice of point_reduction.h for points that arrive one by one instead of in an array. The first pass
 * keeps the points, and the later passes read the kept ones; a stream too long for that is generated once a pass.
 *
 *   pass 0   the farthest along a fixed direction (slot 0), and the deepest
 *   pass 1   the farthest from slot 0 (slot 2)
 *   pass 2   the farthest to the right and left of the line between them (slots 1, 3)
 *   pass 3   if one side is empty: the farthest outside the triangle of the other three
 *
 * The deepest point then replaces the nearest of the four, if it is not among them. The choice does not begin with the
 * deepest point, because all points are nearly equally deep at rest: noise would choose, and every slot would change
 * its point from step to step. Ties go to the earlier point.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONTACT_POINTS_H
#define TANDEM_SHARED_NARROWPHASE_CONTACT_POINTS_H

#include "shared/narrowphase/point_reduction.h"

#define REDUCTION_PASSES 4
#define STREAM_KEPT 16u

typedef struct {
  int pass;
  real lead, narrow; /* the margin by which a point must lead: in a length, in an area */
  leader first, deepest, second, right, left, outermost;
  clip_point kept[STREAM_KEPT]; /* the valid points of the stream */
  uint points;
} reduction;

SHARED void start_reduction(reduction *r, real span, real noise)
{
  clip_point nobody = {R(0.0), R(0.0), R(0.0), 0};
  r->pass = 0;
  r->points = 0u;
  r->lead = span * R(1e-4) + noise;
  r->narrow = R(0.0);
  r->first = r->deepest = leader_above(nobody, R(-1e30));
  r->second = r->right = r->left = r->outermost = leader_above(nobody, R(0.0));
}

/* How far a point lies outside the triangle on its empty side. That side is seen as the left of the line start -> end,
 * whose right side holds the tip. */
SHARED real outside_triangle(const reduction *r, clip_point candidate)
{
  mask right_only = r->right.point.valid;
  clip_point tip = choose_point(right_only, r->right.point, r->left.point);
  clip_point start = choose_point(right_only, r->first.point, r->second.point);
  clip_point end = choose_point(right_only, r->second.point, r->first.point);
  return maximum(area_left_of(start, candidate, tip), area_left_of(candidate, end, tip));
}

SHARED void reduce_step(reduction *r, clip_point candidate)
{
  if (!candidate.valid) return;
  if (r->pass == 0) {
    if (r->points < STREAM_KEPT) r->kept[r->points] = candidate;
    r->points = r->points + 1u;
    r->first = challenged(r->first, candidate, candidate.u * R(0.93) + candidate.v * R(0.37), r->lead);
    r->deepest = challenged(r->deepest, candidate, -candidate.separation, r->lead);
  } else if (r->pass == 1) {
    r->second =
        challenged(r->second, candidate, squared_distance(candidate, r->first.point), r->second.score * R(1e-3));
  } else if (r->pass == 2) {
    real across = area_left_of(r->first.point, r->second.point, candidate);
    r->left = challenged(r->left, candidate, across, r->left.score * R(1e-3));
    r->right = challenged(r->right, candidate, -across, r->right.score * R(1e-3));
  } else {
    r->outermost = challenged(r->outermost, candidate, outside_triangle(r, candidate), r->outermost.score * R(1e-3));
  }
}

/* Runs a pass over the kept points. False if the stream was too long to keep. */
SHARED mask reduce_kept(reduction *r)
{
  if (r->points > STREAM_KEPT) return 0;
  for (uint k = 0u; k < r->points; ++k) reduce_step(r, r->kept[k]);
  return 1;
}

/* Prepares the next pass. False if no further pass is needed. */
SHARED mask next_pass(reduction *r)
{
  int done = r->pass;
  r->pass = done + 1;
  if (done == 0) {
    r->second = leader_above(r->first.point, r->lead * r->lead);
    return r->first.point.valid;
  }
  if (done == 1) {
    r->narrow = square_root(squared_distance(r->first.point, r->second.point)) * r->lead;
    r->left = r->right = leader_above(r->first.point, r->narrow);
    return r->second.point.valid;
  }
  r->outermost = leader_above(r->first.point, r->narrow);
  return done == 2 && r->left.point.valid != r->right.point.valid;
}

SHARED void finish_reduction(clip_point *four, const reduction *r)
{
  mask right_only = r->right.point.valid & (!r->left.point.valid),
       left_only = r->left.point.valid & (!r->right.point.valid);
  four[0] = r->first.point;
  four[1] = choose_point(left_only, r->outermost.point, r->right.point);
  four[2] = r->second.point;
  four[3] = choose_point(right_only, r->outermost.point, r->left.point);
  keep_deepest(four, r->deepest.point, r->lead);
}

#endif
