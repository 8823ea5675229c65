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
  ball_owner owner = {pushed_a && !pushed_b, pushed_b && !pushed_a};
  return owner;
}

/* The slot of the point with the largest separation; a free slot comes first. */
SHARED uint farthest_place(manifold m)
{
  uint last = 0u;
  for (uint slot = 0u; slot < 4u; ++slot) {
    if (!m.kept[slot]) return slot;
    if (m.point[slot].w > m.point[last].w) last = slot;
  }
  return last;
}

SHARED mask has_point_below(manifold m, vec3 foot, real radius)
{
  for (uint slot = 0u; slot < 4u; ++slot) {
    vec3 beside = cross3(m.normal, subtract(xyz(m.point[slot]), foot));
    if (m.kept[slot] && length_squared(beside) < radius * radius) return 1;
  }
  return 0;
}

/* middle: from the centre of a. outward: unit, from the face. height: of the middle above the face. The ball's point
 * takes the last slot, so that a pass over the points solves it last. The code changes with it, because impulses of
 * these points are no guess for those of the next step. */
SHARED manifold with_middle_ball(manifold m, vec3 middle, vec3 outward, real height, real radius)
{
  vec3 foot = add_scaled(middle, outward, -height);
  uint place = farthest_place(m);
  if (!(height > R(0.0)) || !has_points(m) || has_point_below(m, foot, radius)) return m;
  if (m.kept[place] && !(m.point[place].w - least_separation(m) > radius)) return m;
  m.point[place] = m.point[3];
  m.kept[place] = m.kept[3];
  m.point[3] = extend(foot, height - radius);
  m.kept[3] = 1;
  m.code = m.code ^ 0x800000u;
  return m;
}

#endif
