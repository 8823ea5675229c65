/* middle_ball.h - a ball in the middle of a body, which stays in front of the face of a static or kinematic body that
 * the body hits, however the body turns.
 *
 *      .---.                    Points of a manifold move on straight lines, while a body that an impact sets spinning
 *     / (o) \  v                turns on circles. Within the same step its next corner reaches a place where no contact
 *      '---\.'                  is, and its middle passes the face. The ball lies within the body in every orientation,
 *                               and its contact point, perpendicularly below the middle, does not move as the body
 *   ====x=================      turns.
 *
 * The ball adds no contact that should not exist: it acts only if the body would be half inside the wall. It takes the
 * place of the point with the largest separation, if that is larger than the others'. A body that lands flat, or on a
 * point below its middle, keeps all of its points.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H
#define TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H

#include "shared/narrowphase/time_of_impact.h"

/* The radius of the ball as a share of the shape's least size. Every shape that is not nearly flat contains it. */
#define CORE_SHARE R(0.25)

/* Cosine of the angle up to which a contact counts as one with the face of the wall. */
#define WITH_FACE R(0.99)

/* The body that has the ball: the one with a finite mass, if the other one has none. */
typedef struct {
  mask in_a, in_b;
} ball_owner;

SHARED ball_owner owner_of_ball(pair_motion moves)
{
  mask pushed_a = moves.a.inverse_mass > R(0.0), pushed_b = moves.b.inverse_mass > R(0.0);
  ball_owner owner = {pushed_a & (!pushed_b), pushed_b & (!pushed_a)};
  return owner;
}

/* The point with the largest separation; a free slot comes first. */
typedef struct {
  uint_lanes slot;
  real separation;
  mask is_free;
} farthest_point;

SHARED farthest_point farthest_of(manifold m)
{
  farthest_point far = {0u, m.point[0].w, !m.kept[0]};
  for (uint slot = 1u; slot < 4u; ++slot) {
    mask farther = m.point[slot].w > far.separation, takes = (!far.is_free) & ((!m.kept[slot]) | farther);
    far.slot = choose(takes, (uint_lanes)slot, far.slot);
    far.separation = choose(takes, m.point[slot].w, far.separation);
    far.is_free = far.is_free | (takes & (!m.kept[slot]));
  }
  return far;
}

SHARED mask has_point_below(manifold m, vec3 foot, real radius)
{
  mask any = m.kept[0] & (!m.kept[0]);
  for (uint slot = 0u; slot < 4u; ++slot) {
    vec3 beside = cross3(m.normal, subtract(xyz(m.point[slot]), foot));
    any = any | (m.kept[slot] & (length_squared(beside) < radius * radius));
  }
  return any;
}

/* middle: from the centre of a. outward: unit, from the face. height: of the middle above the face. The ball's point
 * takes the last slot, so that a pass over the points solves it last. The code changes with it, because impulses of
 * these points are no guess for those of the next step. wanted: other manifolds stay as they are. */
SHARED manifold with_middle_ball_if(mask wanted, manifold m, vec3 middle, vec3 outward, real height, real radius)
{
  vec3 foot = add_scaled(middle, outward, -height);
  farthest_point far = farthest_of(m);
  wanted = wanted & (height > R(0.0)) & has_points(m) & (!has_point_below(m, foot, radius)) &
           (far.is_free | (far.separation - least_separation(m) > radius));
  for (uint slot = 0u; slot < 3u; ++slot) {
    mask here = wanted & (far.slot == (uint_lanes)slot);
    m.point[slot] = choose4(here, m.point[3], m.point[slot]);
    m.kept[slot] = choose(here, m.kept[3], m.kept[slot]);
  }
  m.point[3] = choose4(wanted, extend(foot, height - radius), m.point[3]);
  m.kept[3] = m.kept[3] | wanted;
  m.code = choose(wanted, m.code ^ 0x800000u, m.code);
  return m;
}

#endif
