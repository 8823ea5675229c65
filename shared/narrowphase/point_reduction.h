/* point_reduction.h - four points that span nearly all of a contact polygon, including its deepest point.
 *
 *              1                 slot 0: farthest along a fixed direction of the reference face
 *          .--*--.               slot 2: farthest from slot 0
 *        *         *             slots 1, 3: farthest to the right and left of the line between
 *      2   `--*--'   0           (if one side is empty: farthest outside the triangle of the other three)
 *              3                 Then the deepest point, if not among them, replaces the nearest.
 *
 * A point must lead the earlier ones by more than rounding can, so that equal corners go to the first candidate and
 * slots keep their points from step to step. The fixed direction differs from the axes and diagonals, where the corners
 * of aligned boxes would tie.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_POINT_REDUCTION_H
#define TANDEM_SHARED_NARROWPHASE_POINT_REDUCTION_H

#include "shared/narrowphase/face_clip.h"

SHARED clip_point choose_point(mask m, clip_point a, clip_point b)
{
  clip_point point;
  point.u = choose(m, a.u, b.u);
  point.v = choose(m, a.v, b.v);
  point.separation = choose(m, a.separation, b.separation);
  point.valid = choose(m, a.valid, b.valid);
  return point;
}

/* The candidate with the highest score so far. */
typedef struct {
  clip_point point;
  real score;
} leader;

SHARED leader leader_above(clip_point nobody, real score)
{
  leader best;
  best.point = nobody;
  best.point.valid = nobody.valid & (!nobody.valid);
  best.score = score;
  return best;
}
SHARED leader challenged(leader best, clip_point candidate, real score, real lead)
{
  mask wins = candidate.valid & (score > best.score + lead);
  leader result;
  result.point = choose_point(wins, candidate, best.point);
  result.score = choose(wins, score, best.score);
  return result;
}

SHARED real squared_distance(clip_point a, clip_point b)
{
  real u = a.u - b.u, v = a.v - b.v;
  return u * u + v * v;
}

/* The deepest candidate takes the slot nearest to it, unless one of the four is as deep. */
SHARED void keep_deepest(clip_point *four, clip_point deepest, real lead)
{
  real chosen = R(1e30), nearest = R(1e30);
  uint_lanes slot = 0u;
  for (int k = 0; k < 4; ++k) {
    real distance = squared_distance(four[k], deepest);
    mask nearer = four[k].valid & (distance < nearest);
    slot = choose(nearer, (uint_lanes)(uint)k, slot);
    nearest = choose(nearer, distance, nearest);
    chosen = choose(four[k].valid, minimum(chosen, four[k].separation), chosen);
  }
  mask missed = deepest.valid & (deepest.separation + lead < chosen);
  for (int k = 0; k < 4; ++k) four[k] = choose_point(missed & (slot == (uint_lanes)(uint)k), deepest, four[k]);
}

/* Twice the area of the triangle a, b, c. It is positive if c lies to the left of the line from a to b. */
SHARED real area_left_of(clip_point a, clip_point b, clip_point c)
{
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/* If the polygon lies on one side of the line from four[0] to four[2], the slot of the empty side takes the candidate
 * farthest outside the triangle. */
SHARED void fill_empty_side(clip_point *four, const clip_point *candidate, real narrow)
{
  mask right_only = four[1].valid & (!four[3].valid), left_only = four[3].valid & (!four[1].valid);
  if (!any_of(right_only | left_only)) return;
  clip_point tip = choose_point(right_only, four[1], four[3]);
  clip_point start = choose_point(right_only, four[0], four[2]), end = choose_point(right_only, four[2], four[0]);
  leader best = leader_above(tip, narrow);
  for (int k = 0; k < CLIP_CANDIDATES; ++k) {
    real outside = maximum(area_left_of(start, candidate[k], tip), area_left_of(candidate[k], end, tip));
    best = challenged(best, candidate[k], outside, best.score * R(1e-3));
  }
  four[1] = choose_point(left_only, best.point, four[1]);
  four[3] = choose_point(right_only, best.point, four[3]);
}

/* span: an upper bound of the polygon's size. noise: rounding error of its corners. */
SHARED void reduce_points(clip_point *four, const clip_point *candidate, real span, real noise)
{
  real lead = span * R(1e-4) + noise;
  leader first = leader_above(candidate[0], R(-1e30)), deepest = first;
  for (int k = 0; k < CLIP_CANDIDATES; ++k) {
    first = challenged(first, candidate[k], candidate[k].u * R(0.93) + candidate[k].v * R(0.37), lead);
    deepest = challenged(deepest, candidate[k], -candidate[k].separation, lead);
  }
  leader second = leader_above(first.point, lead * lead);
  for (int k = 0; k < CLIP_CANDIDATES; ++k) {
    real distance = squared_distance(candidate[k], first.point);
    second = challenged(second, candidate[k], distance, second.score * R(1e-3));
  }
  real narrow = square_root(squared_distance(first.point, second.point)) * lead;
  leader right = leader_above(first.point, narrow), left = right;
  for (int k = 0; k < CLIP_CANDIDATES; ++k) {
    real across = area_left_of(first.point, second.point, candidate[k]);
    left = challenged(left, candidate[k], across, left.score * R(1e-3));
    right = challenged(right, candidate[k], -across, right.score * R(1e-3));
  }
  four[0] = first.point;
  four[1] = right.point;
  four[2] = second.point;
  four[3] = left.point;
  fill_empty_side(four, candidate, narrow);
  keep_deepest(four, deepest.point, lead);
}

#endif
