/* time_of_impact.h - restricts speculative contacts to those that the motion of the step would touch.
 *
 *        v -->                         At the start of the step, the closest points of the ball and the edge have a
 *      .--.                            slanted normal, and a contact there is an infinite plane. It would stop a ball
 *     ( a  )  \  n                     that passes the edge. The bodies are therefore followed along their motion. A
 *      '--'    \                       pair that touches keeps its contacts; if it moves far, they are replaced by
 *               +---------             those of the impact. A pair that misses loses the points that its own motion
 *               | b                    would run into.
 *
 * The pair is repeatedly advanced by the longer of two times in which it cannot touch. The first is gap / closing speed
 * (conservative advancement: Mirtich, "Impulse-based Dynamic Simulation", 1996). The second follows from the gap now
 * and the gap a span later, both along a normal that turns with one of the bodies: in between, no point leaves the
 * chord by more than its acceleration allows.
 *
 *   gap o                          The time before the bound below the chord reaches 0 is free of touching. A pair that
 *       |`- .  chord               turns as it passes is known to miss after a few rounds, even if it rolls along with
 *       |  . ` - . _               hardly a gap. A pair that hits is found by steps that shrink as the square root of
 *       |    `-.....` - o          the gap. If neither body turns, the gap along a normal is the chord itself.
 *       +------------------> time
 *
 * Nothing of this runs at rest: touching points, and gaps that a slow pair does not close, stay as they are.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_TIME_OF_IMPACT_H
#define TANDEM_SHARED_NARROWPHASE_TIME_OF_IMPACT_H

#include "shared/narrowphase/manifold.h"
#include "shared/trigonometry.h"

/* A pair needs more rounds only if a turning body swings past a surface that it nearly touches. The contact is then
 * made early by the gap that is left. */
#define ADVANCEMENT_ROUNDS 128
/* Pairs that do not move far get fewer rounds: the contacts of the start are nearly right for them, and a device would
 * wait for the slowest pair of all. */
#define SLOW_ROUNDS 8
/* A share of the smaller shape's least size. A pair that moves less than this within the step gets the contacts of the
 * start. */
#define FAR_SHARE R(0.25)
/* A share of the gap. Bodies advance by less than the gap, and the manifold computes its own normal, so the distance
 * query may leave this share unknown. */
#define ROUGHLY R(0.1)
/* A share of the least size. Shapes this close count as touching. */
#define TOUCHING_SHARE R(1e-3)
/* A share of the slop. Shapes need not come closer than this within a step. */
#define TOUCHING_SLOP R(0.02)

/* Two bodies with constant velocities that move them within the step as far as gravity does. radius: of the sphere that
 * the spin sweeps; 0 for a sphere in the middle of its body. fall: the part of the velocity of a relative to b that
 * gravity adds. */
typedef struct {
  spatial_velocity a, b;
  real radius_a, radius_b;
  vec3 fall;
} pair_motion;

SHARED pair_motion load_pair_motion(read_bodies bodies, GLOBAL const Parameters *parameters, uint_lanes a, uint_lanes b,
                                    real radius_a, real radius_b)
{
  vec4 first_a = load_float4(bodies.velocity, a * 2u), second_a = load_float4(bodies.velocity, a * 2u + 1u);
  vec4 first_b = load_float4(bodies.velocity, b * 2u), second_b = load_float4(bodies.velocity, b * 2u + 1u);
  vec3 gravity = gravity_at(parameters, bodies.gravity, a);
  vec3 fall_a = mean_fall(parameters, gravity, first_a, second_a),
       fall_b = mean_fall(parameters, gravity, first_b, second_b);
  pair_motion m = {velocity_of_float4s(first_a, second_a), velocity_of_float4s(first_b, second_b), radius_a, radius_b,
                   subtract(fall_a, fall_b)};
  m.a.linear = add(m.a.linear, fall_a);
  m.b.linear = add(m.b.linear, fall_b);
  return m;
}

/* By how much the speed at which gravity closes a gap may exceed its average, along a unit normal from a to b, m/s. A
 * body falls on the exact parabola (integrate/positions.h), but a contact looks ahead along the symplectic Euler step.
 * In the last substep that step falls further by half of the velocity that gravity adds in it. If gravity separates two
 * bodies, they were nearer before. Where islands take different numbers of substeps this is the substep of the few, for
 * all of them, which is the longest: the bound is then larger than the many need. */
SHARED real closing_beyond_mean(GLOBAL const Parameters *parameters, pair_motion m, vec3 normal)
{
  real closing = dot3(m.fall, normal), last_substep = parameters->substep / parameters->step;
  return maximum(closing, R(0.0)) * (R(1.0) + last_substep * last_substep) - closing;
}

/* Bodies without contacts fall on the exact parabola (integrate/positions.h), and others nearly so. Gravity therefore
 * does not extend the reach of contacts: the speculative distance is enough. */
SHARED real reach_of_pair(GLOBAL const Parameters *parameters, pair_motion m, vec3 normal)
{
  spatial_velocity a = m.a;
  a.linear = subtract(a.linear, m.fall);
  return reach_of(parameters, a, m.radius_a, m.b, m.radius_b, normal);
}

/* The highest speed at which the gap along a unit normal from a to b can close. */
SHARED real closing_speed(pair_motion m, vec3 normal)
{
  return dot3(subtract(m.a.linear, m.b.linear), normal) + length_of(cross3(m.a.angular, normal)) * m.radius_a +
         length_of(cross3(m.b.angular, normal)) * m.radius_b;
}
SHARED real fastest_closing(pair_motion m)
{
  return length_of(subtract(m.a.linear, m.b.linear)) + length_of(m.a.angular) * m.radius_a +
         length_of(m.b.angular) * m.radius_b;
}
SHARED real fastest_turning(pair_motion m)
{
  return length_of(m.a.angular) * m.radius_a + length_of(m.b.angular) * m.radius_b;
}

/* The highest acceleration of a point of a body, as seen from a body that turns: the centrifugal and Coriolis terms,
 * m/s^2. distance, speed: of the centres. turning: rad/s. */
SHARED real acceleration_seen(real turning_viewer, real distance, real speed, real turning, real radius)
{
  return turning_viewer * turning_viewer * (distance + radius) + R(2.0) * turning_viewer * (speed + turning * radius) +
         turning * turning * radius;
}

/* The same of a pair, up to the horizon. offset: between the centres at the start. viewer, other: how the two bodies
 * turn; radius: of the other one. */
SHARED real acceleration_beside(pair_motion m, vec3 offset, real horizon, vec3 viewer, vec3 other, real radius)
{
  real speed = length_of(subtract(m.b.linear, m.a.linear)), distance = length_of(offset) + speed * horizon;
  return acceleration_seen(length_of(viewer), distance, speed, length_of(other), radius);
}

/* The centre of b seen from that of a after a time. */
SHARED vec3 offset_after(vec3 offset, pair_motion m, real time)
{
  return add_scaled(offset, subtract(m.b.linear, m.a.linear), time);
}
/* The rotation by a constant angular velocity within a time. */
SHARED mat3 turn_within(vec3 angular, real time)
{
  return rotation_of(turned(make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), scale(angular, time)));
}

/* horizon: how far to look ahead, s. touching: shapes touch up to this gap, m. fastest: no gap closes faster, m/s.
 * roughly: the share of a gap that may stay unknown, and with it the normal. far: whether the pair moves far. */
typedef struct {
  real horizon, touching, fastest, roughly;
  mask far;
} toi_input;

SHARED toi_input toi_input_of(real fastest, real horizon, real least, real size)
{
  real rounding = R(16.0) * ROUNDING * (fastest * horizon + size);
  toi_input input = {horizon, maximum(TOUCHING_SHARE * least, rounding), fastest, R(0.0), fastest == fastest};
  return input;
}

/* The input of one step. Contacts are speculative, to allow for gravity and other contacts: the motion is followed past
 * the end of the step until it has grown by the speculative distance. least: the smaller of the two sizes; size: of
 * both. */
SHARED toi_input toi_input_of_step(GLOBAL const Parameters *parameters, pair_motion moves, real least, real size)
{
  real fastest = maximum(fastest_closing(moves), R(1e-6));
  real horizon = parameters->step + parameters->speculative_distance / fastest;
  toi_input input =
      toi_input_of(fastest, horizon, minimum(least, parameters->slop * (TOUCHING_SLOP / TOUCHING_SHARE)), size);
  input.roughly = ROUGHLY;
  input.far = fastest * parameters->step > FAR_SHARE * least;
  return input;
}

/* The state of an advancement. active: it goes on. hits: the pair touches at `time`. If neither holds, the pair does
 * not touch before the horizon. */
typedef struct {
  mask active, hits;
  real time; /* s: the pair does not touch before it */
} advancement;

SHARED advancement start_advancement(mask wanted)
{
  advancement at = {wanted, wanted & (!wanted), R(0.0)};
  return at;
}

/* The span after which the second gap is measured, s. The chord is then off by at most a quarter of the first gap. */
SHARED real span_of(advancement at, real gap, real acceleration, toi_input input)
{
  real rest = maximum(input.horizon - at.time, R(0.0));
  mask bends = acceleration > R(0.0);
  return choose(bends,
                minimum(rest, square_root(R(2.0) * maximum(gap, R(0.0)) / choose(bends, acceleration, (real)R(1.0)))),
                rest);
}
/* The part of the span that is free of touching, s. */
SHARED real free_by_chord(real gap, real gap_then, real span, real acceleration, toi_input input)
{
  real stray = R(0.125) * acceleration * span * span, margin = gap - R(0.5) * input.touching;
  mask clear = gap_then - stray > R(0.5) * input.touching;
  return span * choose(clear, (real)R(1.0), margin / choose(clear, (real)R(1.0), gap - gap_then + R(4.0) * stray));
}

/* gap: along a normal. closing: the highest speed at which it closes. chord: the time free by the chord bound, s. */
SHARED advancement advanced(advancement at, uint round, real gap, real closing, real chord, toi_input input)
{
  uint_lanes rounds = choose(input.far, (uint_lanes)(uint)ADVANCEMENT_ROUNDS, (uint_lanes)(uint)SLOW_ROUNDS);
  mask touches = at.active & ((gap <= input.touching) | (rounds == round + 1u));
  mask closes = (closing > R(0.0)) & (gap <= input.fastest * (input.horizon - at.time));
  real time = at.time + maximum((gap - R(0.5) * input.touching) / choose(closes, closing, (real)R(1.0)), chord);
  advancement next;
  next.active = at.active & (!touches) & closes & (time < input.horizon);
  next.hits = at.hits | touches;
  next.time = choose(next.active, time, at.time);
  return next;
}

SHARED mask has_points(manifold m) { return m.kept[0] | m.kept[1] | m.kept[2] | m.kept[3]; }

SHARED real least_separation(manifold m)
{
  real least = R(1e30);
  for (int slot = 0; slot < 4; ++slot) least = choose(m.kept[slot], minimum(least, m.point[slot].w), least);
  return least;
}

/* The speed at which a contact plane moves along the normal because its arm follows the sliding of the bodies
 * (shift_of_arms of setup/contact.h), m/s: toward the other body, and in either direction. The bound covers bodies that
 * nothing pushes; that of both bodies holds if nothing else turns them. */
typedef struct {
  real toward, either_way;
} slide_closing;

SHARED slide_closing closing_by_slide(GLOBAL const Parameters *parameters, pair_motion m, vec3 normal)
{
  real zero = R(0.0), share = share_of_slide(m.a, m.b);
  real driven = choose(m.a.inverse_mass == zero, length_of(m.a.angular), zero) +
                choose(m.b.inverse_mass == zero, length_of(m.b.angular), zero);
  vec3 slide = scale(subtract(m.b.linear, m.a.linear), parameters->step);
  vec3 turning = add(scale(m.a.angular, share), scale(m.b.angular, R(1.0) - share));
  real of_driven = driven * length_of(slide), of_both = dot3(cross3(slide, normal), turning);
  slide_closing s = {maximum(of_driven, of_both), maximum(of_driven, magnitude(of_both))};
  return s;
}

/* A body that turns this far does not move on a line, so it would hit the plane of a contact point that it passes. */
SHARED mask swings_far(GLOBAL const Parameters *parameters, real fastest, real least)
{
  return fastest * parameters->step > FAR_SHARE * least;
}

/* The speeds at which the points of a manifold close, m/s: the average, the upper bound, and that of arms that follow.
 * reached: the points that the motion may touch within the step. */
typedef struct {
  real closing[4], fastest[4];
  mask reached[4];
  slide_closing by_slide;
} approaching_points;

/* offset: from the centre of a to the centre of b, at the same moment as the points. */
SHARED approaching_points approach_of_points(GLOBAL const Parameters *parameters, manifold m, vec3 offset,
                                             pair_motion moves)
{
  approaching_points points;
  real beyond_mean = closing_beyond_mean(parameters, moves, m.normal);
  points.by_slide = closing_by_slide(parameters, moves, m.normal);
  for (int slot = 0; slot < 4; ++slot) {
    vec3 arm = xyz(m.point[slot]);
    real closing = dot3(m.normal, subtract(velocity_at(moves.a, arm), velocity_at(moves.b, subtract(arm, offset))));
    points.closing[slot] = maximum(closing, R(0.0));
    points.fastest[slot] = maximum(closing + beyond_mean, R(0.0));
    points.reached[slot] = m.kept[slot] & (points.fastest[slot] * parameters->step >= m.point[slot].w);
  }
  return points;
}
/* turning: the additional closing speed by arms that follow, m/s. */
SHARED mask reaches_point(GLOBAL const Parameters *parameters, manifold m, approaching_points points, int slot,
                          real turning)
{
  return m.kept[slot] & ((points.fastest[slot] + turning) * parameters->step >= m.point[slot].w);
}
SHARED mask reaches_any_point(GLOBAL const Parameters *parameters, manifold m, vec3 offset, pair_motion moves)
{
  approaching_points points = approach_of_points(parameters, m, offset, moves);
  mask any = reaches_point(parameters, m, points, 0, points.by_slide.either_way);
  for (int slot = 1; slot < 4; ++slot)
    any = any | reaches_point(parameters, m, points, slot, points.by_slide.either_way);
  return any;
}

/* asked: the speculative contacts, whose points are all apart, that must be examined. They are those that the motion of
 * the step reaches (reached), which are followed, and those of a body that swings far. */
typedef struct {
  mask asked, reached, a_swings, b_swings;
  real margin; /* m: points of passing bodies may be moved by so much to clear them */
} speculation;

/* A share of the least size of a pair whose bodies can both be pushed. */
#define MARGIN_SHARE R(0.05)

/* The bound for whole bodies comes first, because it excludes nearly all pairs from the rest. A pair that does not move
 * far, and therefore does not swing far, and that reaches none of its points would keep all of them, so it is not
 * examined. */
SHARED speculation speculation_of(GLOBAL const Parameters *parameters, manifold m, vec3 offset, pair_motion moves,
                                  toi_input input, real least)
{
  real gap = least_separation(m);
  speculation s;
  s.margin =
      choose((moves.a.inverse_mass > R(0.0)) & (moves.b.inverse_mass > R(0.0)), MARGIN_SHARE * least, (real)R(0.0));
  s.a_swings = swings_far(parameters, length_of(moves.a.angular) * moves.radius_a, least);
  s.b_swings = swings_far(parameters, length_of(moves.b.angular) * moves.radius_b, least);
  mask ahead = has_points(m) & (gap > input.touching);
  real closing = closing_speed(moves, m.normal) + closing_by_slide(parameters, moves, m.normal).either_way +
                 closing_beyond_mean(parameters, moves, m.normal);
  s.reached = ahead & (closing * parameters->step > gap);
  s.asked = s.reached | (ahead & (s.a_swings | s.b_swings));
  if (any_of(s.asked & (!input.far))) {
    s.asked = s.asked & (input.far | reaches_any_point(parameters, m, offset, moves));
    s.reached = s.reached & s.asked;
  }
  return s;
}

/* The outcome for speculative contacts. If no mask holds, the contacts stay. */
typedef struct {
  mask at_impact; /* they are replaced by those of `time` */
  mask missed;
  mask passing; /* the bodies do not meet within the step */
  mask a_swings, b_swings;
  real time;   /* s */
  real margin; /* m, as of speculation */
} encounter;

/* A pair that does not move far gets the contacts of the start. A pair that misses while one of its bodies swings far
 * gets those of the end of the step (guard_of). */
SHARED encounter encounter_of(GLOBAL const Parameters *parameters, speculation s, advancement at, toi_input input)
{
  mask missed = s.asked & (!at.hits), meets = s.asked & at.hits & input.far & (at.time > R(0.0));
  mask one_swings = (s.a_swings | s.b_swings) & (!(s.a_swings & s.b_swings));
  encounter met = {meets | (missed & one_swings),
                   missed,
                   missed,
                   s.a_swings,
                   s.b_swings,
                   choose(at.hits, at.time, (real)parameters->step),
                   s.margin};
  return met;
}

/* The contact of the end of the step, for a body that swings far and misses a body that nothing pushes. It keeps other
 * contacts from bringing the body nearer than it is then. The contact stands at the centre of the body, where its
 * turning moves nothing, so that its own motion ends ahead of it. The contact is left out where the turning of the
 * other body moves the point by much. If both bodies can be pushed, neither is guarded. */
SHARED manifold guard_of(GLOBAL const Parameters *parameters, manifold end, mask a_swings, vec3 offset,
                         pair_motion moves)
{
  vec3 point = choose3(a_swings, make_vec3(R(0.0), R(0.0), R(0.0)), offset);
  real gap = least_separation(end), turning = length_of(choose3(a_swings, moves.b.angular, moves.a.angular));
  mask quiet = turning * length_of(offset) * parameters->step < R(0.25) * gap;
  real pushed = choose(a_swings, moves.a.inverse_mass, moves.b.inverse_mass),
       other = choose(a_swings, moves.b.inverse_mass, moves.a.inverse_mass);
  manifold guard =
      single_contact(end.normal, point, gap, has_points(end) & quiet & (pushed > R(0.0)) & (other == R(0.0)));
  guard.code = end.code;
  return guard;
}

/* This factor on the distance that comes nearer keeps rounding from making the point touch. */
#define CLEARLY R(1.01)

/* Moves a manifold from the moment of the impact back to the start of the step. The points were farther apart then by
 * what they close until the impact; points of bodies that miss each other, by what they may close within the whole
 * step. A point that parts was not nearer before, because what turns does not move on a line. Bodies that miss each
 * other and do not swing keep those contacts of the start that their own motion does not reach, because other bodies
 * may push them. If only arms that follow would turn the plane of a contact into its point, the point is put clear of
 * the plane: impulses through it then keep angular momentum, though they may push the bodies that far into each other.
 * Where the margin does not suffice for that, the arms do not follow. offset: centre of b from that of a, at the moment
 * of the contacts. */
SHARED manifold as_seen_from_start(GLOBAL const Parameters *parameters, manifold found, encounter met, vec3 offset,
                                   pair_motion moves)
{
  manifold m =
      choose_manifold(met.missed & met.at_impact, guard_of(parameters, found, met.a_swings, offset, moves), found);
  approaching_points points = approach_of_points(parameters, m, offset, moves);
  mask swings = met.a_swings | met.b_swings, turned_into = swings & (!swings);
  /* The arms of a moment other than the start are off by the sliding until then or after it, and so turn either way. */
  real farthest = choose(met.at_impact, maximum(met.time / parameters->step, (real)R(1.0)), (real)R(1.0));
  real either_way = points.by_slide.either_way * farthest;
  real toward = choose(met.at_impact, either_way, points.by_slide.toward);
  for (int slot = 0; slot < 4; ++slot) {
    m.kept[slot] = m.kept[slot] & (met.at_impact | (!met.missed) | (!(swings | points.reached[slot])));
    turned_into = turned_into | (met.passing & reaches_point(parameters, m, points, slot, either_way));
  }
  mask arms_stay = turned_into & (either_way * parameters->step > met.margin);
  for (int slot = 0; slot < 4; ++slot) {
    real closed = choose(met.passing, points.fastest[slot] * maximum(met.time, parameters->step),
                         points.closing[slot] * met.time);
    real clear = CLEARLY * (points.fastest[slot] + toward) * parameters->step;
    mask unclear = turned_into & (!arms_stay) & (m.point[slot].w < clear);
    m.point[slot].w = choose(met.at_impact, m.point[slot].w + closed, m.point[slot].w);
    m.point[slot].w = choose(unclear, maximum(m.point[slot].w, clear), m.point[slot].w);
  }
  m.impact_time = packed_moment(choose(met.at_impact, met.time, (real)R(0.0)), arms_stay);
  return m;
}

#endif
