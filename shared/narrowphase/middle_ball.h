/* middle_ball.h - a body that hits what nothing pushes keeps a ball in its middle before the face that it hits, however it turns.
 *
 *      .---.                    Points of a manifold move on lines. What an impact sets spinning turns on circles: within the same step
 *     / (o) \  v                its next corner comes where no point is, and its middle passes the face. The ball lies within the body
 *      '---\.'                  as the body turns, and its point, square below the middle, is turned by nothing.
 *   ====x=================
 *
 * So it adds nothing that is not there: it acts only where the body would be half in the wall. It stands in for the point that is
 * farthest from touching, where that is farther than the others; a body that lands flat, or on a point below its middle, keeps all of
 * its points.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H
#define TANDEM_SHARED_NARROWPHASE_MIDDLE_BALL_H

#include "shared/narrowphase/time_of_impact.h"

/* Radius of the ball, of the shape's least size: within every shape that is not nearly flat. */
#define CORE_SHARE R(0.25)

/* Which of the two bodies has the ball: the one that can be pushed, if the other cannot. */
typedef struct { mask in_a, in_b; } ball_owner;

SHARED ball_owner owner_of_ball(pair_motion moves)
{
  real zero = R(0.0);
  mask pushed_a = moves.a.inverse_mass > zero, pushed_b = moves.b.inverse_mass > zero;
  ball_owner owner = {pushed_a & (!pushed_b), pushed_b & (!pushed_a)};
  return owner;
}

/* foot: of the middle on the face, from the centre of a; height: of the middle above it. In the last place, so that a pass over the
 * points leaves it as it shall be. The code is another then: what these points
 * carry says nothing of the next step. */
SHARED manifold with_middle_ball(manifold m, mask wanted, vec3 foot, real height, real radius)
{
  real farthest = R(-1e30);
  natural last = 0u;
  mask is_there = m.kept[0] & (!m.kept[0]);
  for (uint slot = 0u; slot < 4u; ++slot) {
    vec3 beside = outer(m.normal, subtract(xyz(m.point[slot]), foot));
    is_there = is_there | (m.kept[slot] & (length_squared(beside) < radius * radius));
    real separation = choose(m.kept[slot], m.point[slot].w, (real)FAR_APART);
    mask farther = separation > farthest;
    farthest = choose(farther, separation, farthest);
    last = choose(farther, (natural)slot, last);
  }
  mask placed = wanted & has_points(m) & (!is_there) & (farthest - least_separation(m) > radius);
  for (uint slot = 0u; slot < 3u; ++slot) {
    mask here = placed & (last == (natural)slot);
    m.point[slot] = choose4(here, m.point[3], m.point[slot]);
    m.kept[slot] = (m.kept[slot] & (!here)) | (here & m.kept[3]);
  }
  m.point[3] = choose4(placed, extend(foot, height - radius), m.point[3]);
  m.kept[3] = m.kept[3] | placed;
  m.code = choose(placed, m.code ^ 0x800000u, m.code);
  return m;
}

#endif
