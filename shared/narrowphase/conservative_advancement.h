/* conservative_advancement.h - when two moving convex shapes meet within the step, and where they are at that moment.
 *
 *    start            impact       The bodies move with the velocities they start with. Along the direction of
 *     .--.    v  |     .--.|       the closest points, no part of one nears the other faster than the bodies
 *    ( a  ) ---> |  - ( a  )| b    approach plus the speed that their spin adds. They are repeatedly advanced by the
 *     '--'       |     '--'|       time in which they cannot touch (van den Bergen, "Ray Casting against General Convex
 *      <-- gap -->                 Objects", 2004; Zhang, Lee, Kim, "Interactive Continuous Collision Detection for
 *                                  Non-Convex Polyhedra", 2006).
 *
 * The solver gets the manifold of the impact as a speculative one of the start of the step: each separation is larger
 * by what the point closes until the impact, so the ordinary constraint rows stop the bodies at the surface and no
 * substep of their own is needed. The arms stay those of the impact (setup/contact.h). Bodies that pass each other get
 * no contact that could push them.
 *
 * The file time_of_impact.h decides which contacts are followed, and how far a pair is advanced.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H
#define TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H

#include "shared/narrowphase/gjk.h"
#include "shared/narrowphase/time_of_impact.h"

/* A shape of a body that moves with constant velocities. Offsets are seen from the centre of body a at the start. */
typedef struct {
  convex shape; /* at the start, world axes */
  vec3 pivot;   /* centre of the body */
  vec3 linear, angular;
  real radius; /* of the sphere that the spin sweeps; 0 for a sphere in the middle of its body */
} moving_convex;

SHARED moving_convex moving_convex_of(const convex *shape, vec3 pivot, vec3 linear, vec3 angular, real radius)
{
  moving_convex m;
  m.shape = *shape;
  m.pivot = pivot;
  m.linear = linear;
  m.angular = angular;
  m.radius =
      shape->kind == (uint)SHAPE_SPHERE && length_squared(subtract(shape->center, pivot)) <= R(0.0) ? R(0.0) : radius;
  return m;
}

/* The shape after a time, seen from a point that moves with the velocity `seen_from`. The velocity of body a keeps the
 * coordinates near the impact small. */
SHARED convex shape_at(const moving_convex *m, vec3 seen_from, real time)
{
  convex shape = m->shape;
  mat3 turn = turn_within(m->angular, time);
  vec3 pivot = add_scaled(m->pivot, subtract(m->linear, seen_from), time);
  shape.rotation = turned_axes(turn, shape.rotation);
  shape.center = add(pivot, rotate(turn, subtract(shape.center, m->pivot)));
  return shape;
}

/* The highest speed that the spin gives any part of a shape along a unit direction. */
SHARED real swing_along(const moving_convex *m, vec3 direction)
{
  return length_of(cross3(m->angular, direction)) * m->radius;
}
SHARED real fastest_swing(const moving_convex *m) { return length_of(m->angular) * m->radius; }

/* The first touch of two shapes, if they touch before the horizon. */
typedef struct {
  advancement at;
  real gap;    /* at that time; negative where they overlap */
  vec3 normal; /* at that time, unit, from a to b */
} impact;

SHARED impact no_impact(void)
{
  impact met = {start_advancement(1), R(0.0), make_vec3(R(1.0), R(0.0), R(0.0))};
  return met;
}

/* The time that is free of touching by the chord bound along a normal fixed to the viewer, which turns with it.
 * outward: the normal from the viewer to the other shape. */
SHARED real free_beside(const moving_convex *viewer, const moving_convex *other, vec3 seen_from, vec3 outward, real gap,
                        advancement at, toi_input input)
{
  vec3 offset = subtract(other->pivot, viewer->pivot);
  real speed = length_of(subtract(other->linear, viewer->linear)), distance = length_of(offset) + speed * input.horizon;
  real acceleration =
      acceleration_seen(length_of(viewer->angular), distance, speed, length_of(other->angular), other->radius);
  real span = span_of(at, gap, acceleration, input);
  convex viewer_then = shape_at(viewer, seen_from, at.time + span),
         other_then = shape_at(other, seen_from, at.time + span);
  vec3 outward_then = rotate(turn_within(viewer->angular, span), outward);
  real gap_then =
      gap_along(&viewer_then, &other_then, outward_then) - core_radius(&viewer_then) - core_radius(&other_then);
  return free_by_chord(gap, gap_then, span, acceleration, input);
}

/* Measures gap and normal at a time; what counts as touching is known for sure. The search starts from the normal so
 * far, or from the centres. */
SHARED void measure_gap(impact *met, const moving_convex *a, const moving_convex *b, toi_input input, real time,
                        mask from_normal)
{
  convex shape_a = shape_at(a, a->linear, time), shape_b = shape_at(b, a->linear, time);
  convex_pair pair = pair_of(&shape_a, &shape_b);
  real radii = core_radius(&shape_a) + core_radius(&shape_b);
  vec3 guess = from_normal ? rotate_back(pair.axes, pair.swapped ? met->normal : negate(met->normal))
                           : subtract(pair.a.center, pair.b.center);
  gap_wanted wanted = {input.fastest * (input.horizon - time) + input.touching + radii, input.roughly, radii};
  gjk_result near = closest_points_from(&pair.a, &pair.b, wanted, guess);
  vec3 along = rotate(pair.axes, near.contact.normal);
  met->normal = pair.swapped ? negate(along) : along;
  met->gap = (near.overlapping ? R(0.0) : near.contact.gap) - radii;
}

SHARED impact first_impact(const moving_convex *a, const moving_convex *b, toi_input input)
{
  impact met = no_impact();
  vec3 approach = subtract(a->linear, b->linear);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && met.at.active; ++round) {
    measure_gap(&met, a, b, input, met.at.time, round > 0u);
    real closing = dot3(met.normal, approach) + swing_along(a, met.normal) + swing_along(b, met.normal);
    real chord = R(0.0);
    if (met.gap > input.touching && met.gap < closing * (input.horizon - met.at.time)) {
      real seen_by_a = free_beside(a, b, a->linear, met.normal, met.gap, met.at, input);
      chord = maximum(seen_by_a, free_beside(b, a, a->linear, negate(met.normal), met.gap, met.at, input));
    }
    met.at = advanced(met.at, round, met.gap, closing, chord, input);
  }
  return met;
}

/* The gap between a body and a half-space after a time. up: unit normal of the plane. height: of the plane along it.
 * rising: the speed at which the plane nears the body. */
SHARED real gap_above_plane(const moving_convex *body, vec3 up, real height, real rising, real time)
{
  convex shape = shape_at(body, body->linear, time);
  return dot3(up, support_of(&shape, negate(up))) - core_radius(&shape) - (height + rising * time);
}

/* velocity: of the plane. */
SHARED impact first_impact_on_plane(const moving_convex *body, vec3 up, real height, vec3 velocity, toi_input input)
{
  impact met = no_impact();
  real rising = dot3(up, subtract(velocity, body->linear));
  real acceleration = acceleration_seen(R(0.0), R(0.0), R(0.0), length_of(body->angular), body->radius);
  met.normal = negate(up);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && met.at.active; ++round) {
    met.gap = gap_above_plane(body, up, height, rising, met.at.time);
    real span = span_of(met.at, met.gap, acceleration, input),
         gap_then = gap_above_plane(body, up, height, rising, met.at.time + span);
    met.at = advanced(met.at, round, met.gap, rising + swing_along(body, up),
                      free_by_chord(met.gap, gap_then, span, acceleration, input), input);
  }
  return met;
}

/* Whether two bodies touch at the end of their motion, so that they have met. Where they do not move far either, they
 * keep the contacts of the start (encounter_of), as nearly all pairs that come to rest do. */
SHARED mask touches_at_end(const moving_convex *a, const moving_convex *b, toi_input input)
{
  impact end = no_impact();
  measure_gap(&end, a, b, input, input.horizon, 0);
  return end.gap <= input.touching;
}

/* Finds the impact of two shapes, seen from the centre of the first one's body. Both are moved to their poses at the
 * impact if the manifold is to be made there. */
SHARED encounter meet(GLOBAL const Parameters *parameters, convex *first, convex *second, vec3 offset,
                      pair_motion moves, toi_input input, speculation s)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex a = moving_convex_of(first, none, moves.a.linear, moves.a.angular, moves.radius_a);
  moving_convex b = moving_convex_of(second, offset, moves.b.linear, moves.b.angular, moves.radius_b);
  advancement at = start_advancement(0);
  if (s.reached && !input.far && touches_at_end(&a, &b, input)) at.hits = 1;
  else if (s.reached) at = first_impact(&a, &b, input).at;
  encounter met = encounter_of(parameters, s, at, input);
  if (met.at_impact) {
    *first = shape_at(&a, a.linear, met.time);
    *second = shape_at(&b, a.linear, met.time);
  }
  return met;
}

/* The impact of a body, seen from its own centre, with a half-space. `height` becomes the plane's height at the
 * impact. */
SHARED encounter meet_plane(GLOBAL const Parameters *parameters, convex *shape, vec3 up, real *height,
                            spatial_velocity body, real radius, spatial_velocity plane, toi_input input, speculation s)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex moving = moving_convex_of(shape, none, body.linear, body.angular, radius);
  encounter met = encounter_of(
      parameters, s,
      s.reached ? first_impact_on_plane(&moving, up, *height, plane.linear, input).at : start_advancement(0), input);
  if (met.at_impact) {
    *shape = shape_at(&moving, moving.linear, met.time);
    *height = *height - dot3(up, subtract(body.linear, plane.linear)) * met.time;
  }
  return met;
}

#endif
