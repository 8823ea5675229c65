/* time_of_impact.h - a contact ahead of touching is made only where the motion of the step would touch.
 *
 *        v -->                         Seen from the start of the step, the closest points of the ball and the edge have a
 *      .--.                            slanted normal, and a contact there is an endless plane: it would stop a ball that
 *     ( a  )  \  n                     passes the edge. So the bodies are followed along their motion. A pair that touches
 *      '--'    \                       keeps its contacts; if it moves far, they are those of the moment of impact. A pair
 *               +---------             that misses loses the points that its own motion would run into.
 *               | b
 *
 * The pair is advanced by the time in which it cannot touch, gap / closing speed, again and again (conservative advancement:
 * Mirtich, "Impulse-based Dynamic Simulation", 1996). For bodies that do not turn the gap is a convex function of time and each
 * advance is one of Newton's steps, so a few suffice.
 *
 * At rest nothing of this runs: touching points, and gaps that a slow pair does not close, are left as they are.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_TIME_OF_IMPACT_H
#define TANDEM_SHARED_NARROWPHASE_TIME_OF_IMPACT_H

#include "shared/narrowphase/manifold.h"
#include "shared/trigonometry.h"

/* More are needed only where turning swings by a surface that it nearly touches; the contact is then made that much early. */
#define ADVANCEMENT_ROUNDS 128
/* For a pair that does not move far the contacts of the start are nearly right; a device would wait for the slowest pair of all. */
#define SLOW_ROUNDS 8
/* Of the smaller shape's least size: a pair that moves less within the step meets as it stands at the start. */
#define FAR_SHARE R(0.25)
/* Of the least size: shapes this close count as touching. */
#define TOUCHING_SHARE R(1e-3)
/* Of the slop: nor need they come closer than this. */
#define TOUCHING_SLOP R(0.02)

/* Two bodies that move evenly. radius: that turning swings round; 0 for a sphere in the middle of its body. */
typedef struct {
  motion a, b;
  real radius_a, radius_b;
} pair_motion;

/* At most this fast the gap along a unit normal from a to b closes. */
SHARED real closing_speed(pair_motion m, vec3 normal)
{
  return inner(subtract(m.a.linear, m.b.linear), normal) + length_of(outer(m.a.angular, normal)) * m.radius_a +
         length_of(outer(m.b.angular, normal)) * m.radius_b;
}
SHARED real fastest_closing(pair_motion m)
{
  return length_of(subtract(m.a.linear, m.b.linear)) + length_of(m.a.angular) * m.radius_a + length_of(m.b.angular) * m.radius_b;
}
SHARED real fastest_turning(pair_motion m) { return length_of(m.a.angular) * m.radius_a + length_of(m.b.angular) * m.radius_b; }

/* The centre of b seen from that of a after a time. */
SHARED vec3 offset_after(vec3 offset, pair_motion m, real time) { return add_scaled(offset, subtract(m.b.linear, m.a.linear), time); }
/* The rotation that an even spin makes within a time. */
SHARED mat3 turn_within(vec3 angular, real time) { return rotation_of(turned(make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), scale(angular, time))); }

/* How far to look, s; from which gap on shapes touch, m; no gap closes faster, m/s; how often to look. */
typedef struct {
  real horizon, touching, fastest;
  natural rounds;
} journey;

SHARED journey journey_of(real fastest, real horizon, real least, real size)
{
  journey way = {horizon, maximum(TOUCHING_SHARE * least, R(16.0) * ROUNDING * (fastest * horizon + size)), fastest, (natural)(uint)ADVANCEMENT_ROUNDS};
  return way;
}

/* The journey of one step. Contacts are made somewhat ahead of touching, for what gravity and other contacts add: the motion is
 * followed past the end of the step until it has grown by that distance. least: of the sizes of the two; size: of both. */
SHARED journey journey_of_step(GLOBAL const Parameters *parameters, pair_motion moves, real least, real size)
{
  real fastest = maximum(fastest_closing(moves), R(1e-6));
  real horizon = parameters->step + parameters->speculative_distance / fastest;
  journey way = journey_of(fastest, horizon, minimum(least, parameters->slop * (TOUCHING_SLOP / TOUCHING_SHARE)), size);
  way.rounds = choose(fastest * parameters->step > FAR_SHARE * least, way.rounds, (natural)(uint)SLOW_ROUNDS);
  return way;
}

/* Where a pair has come. active: it goes on; hits: it touches at `time`. Neither: it does not touch before the horizon. */
typedef struct {
  mask active, hits;
  real time; /* s: up to here it does not touch */
} advancement;

SHARED advancement start_advancement(mask wanted)
{
  advancement at = {wanted, wanted & (!wanted), R(0.0)};
  return at;
}

SHARED advancement advanced(advancement at, uint round, real gap, real closing, journey way)
{
  mask touches = at.active & ((gap <= way.touching) | (way.rounds == round + 1u));
  mask closes = (closing > R(0.0)) & (gap <= way.fastest * (way.horizon - at.time));
  real next = at.time + (gap - R(0.5) * way.touching) / choose(closes, closing, (real)R(1.0));
  at.active = at.active & (!touches) & closes & (next < way.horizon);
  at.hits = at.hits | touches;
  at.time = choose(at.active, next, at.time);
  return at;
}

SHARED mask has_points(manifold m) { return m.kept[0] | m.kept[1] | m.kept[2] | m.kept[3]; }

SHARED real least_separation(manifold m)
{
  real least = R(1e30);
  for (int slot = 0; slot < 4; ++slot) least = choose(m.kept[slot], minimum(least, m.point[slot].w), least);
  return least;
}

/* Which contacts of the start are in question: those of pairs with all points ahead of touching, where the step may close the gap
 * (`reached`), or where some body swings far: what turns moves on no line, so that it would meet the plane of a point beside it. */
typedef struct { mask asked, reached, far, swings; } doubt;

SHARED doubt doubt_of(GLOBAL const Parameters *parameters, manifold m, pair_motion moves, journey way, real least)
{
  real gap = least_separation(m);
  mask ahead = has_points(m) & (gap > way.touching);
  doubt d;
  d.far = way.fastest * parameters->step > FAR_SHARE * least;
  d.swings = fastest_turning(moves) * parameters->step > FAR_SHARE * least;
  d.reached = ahead & (closing_speed(moves, m.normal) * way.horizon > gap);
  d.asked = d.reached | (ahead & d.swings);
  return d;
}

/* What becomes of the contacts in question. Neither mask: they stay. */
typedef struct {
  mask at_impact; /* they are replaced by those of `time` */
  mask missed;
  mask swings;
  real time; /* s */
} encounter;

SHARED encounter encounter_of(doubt d, advancement at)
{
  encounter met = {d.asked & at.hits & d.far & (at.time > R(0.0)), d.asked & (!at.hits), d.swings, at.time};
  return met;
}

/* From the moment of the impact back to the start of the step: points were as far apart again as they close until then. A point
 * that parts was not nearer before: what turns does not move on a line. Bodies that miss each other keep, of
 * the contacts at the start, those that their own motion does not reach, if they do not swing: gravity or others may push them.
 * offset: centre of b from that of a, at the moment of the contacts. */
SHARED manifold as_seen_from_start(GLOBAL const Parameters *parameters, manifold found, encounter met, vec3 offset, pair_motion moves)
{
  manifold m = found;
  for (int slot = 0; slot < 4; ++slot) {
    vec3 arm = xyz(m.point[slot]);
    real closing = maximum(inner(m.normal, subtract(velocity_at(moves.a, arm), velocity_at(moves.b, subtract(arm, offset)))), R(0.0));
    mask idle = (!met.swings) & (closing * parameters->step < m.point[slot].w);
    m.kept[slot] = m.kept[slot] & (idle | (!met.missed));
    m.point[slot].w = choose(met.at_impact, m.point[slot].w + closing * met.time, m.point[slot].w);
  }
  m.impact_time = choose(met.at_impact, met.time, (real)R(0.0));
  return m;
}

#endif
