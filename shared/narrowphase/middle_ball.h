/* middle_ball.h - a body that hits what nothing pushes keeps a ball in its middle before the face that it hits, however
 * it turns.
 *
 *      .---.                    Points of a manifold move on lines. What an impact sets spinning turns on circles:
 *     / (o) \  v                within the same step its next corner comes where no point is, and its middle passes the
 *      '---\.'                  face. The ball lies within the body as the body turns, and its point, square below the
 *                               middle, is turned by nothing.
 *   ====x=================
 *
 * So it adds nothing that is not there: it acts only where the body would be half in the wall. It stands in for the
 * point that is farthest from touching, where that is farther than the others; a body that lands flat, or on a point
 * below its middle, keeps all of its points.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H
#define TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H

#include "shared/narrowphase/time_of_impact.h"

/* Radius of the ball, of the shape's least size: within every shape that is not nearly flat. */
#define CORE_SHARE R(0.25)

/* Cosine of the angle up to which a contact counts as one with the face of a wall. */
#define WITH_FACE R(0.99)

/* Which of the two bodies has the ball: the one that can be pushed, if the other cannot. */
typedef struct {
  mask in_a, in_b;
} ball_owner;

SHARED ball_owner owner_of_ball(pair_motion moves)
{
  mask pushed_a = moves.a.inverse_mass > R(0.0), pushed_b = moves.b.inverse_mass > R(0.0);
  ball_owner owner = {pushed_a && !pushed_b, pushed_b && !pushed_a};
  return owner;
}

/* The place of the point that is farthest from touching; one that is free before all. */
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

/* middle: from the centre of a; outward: unit, from the face; height: of the middle above it. The ball's point comes in
 * the last place, so that a pass over the points leaves it as it shall be. The code is another then: what these points
 * carry says nothing of the next step. */
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
