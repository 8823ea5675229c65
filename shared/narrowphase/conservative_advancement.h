/* conservative_advancement.h - when any two moving convex shapes meet within the step, and where they are at that moment.
 *
 *    start            impact          The bodies move with the velocities they start with. Along the direction of the closest
 *     .--.    v  |     .--.|          points no part of one nears the other faster than the bodies approach and their turning
 *    ( a  ) ---> |  - ( a  )| b       swings round, so gap / speed is time in which they cannot touch: they are advanced by it,
 *     '--'       |     '--'|          again and again (Mirtich, "Impulse-based Dynamic Simulation", 1996; van den Bergen, "Ray
 *      <-- gap -->                    Casting against General Convex Objects", 2004; Zhang, Lee, Kim, "Interactive Continuous
 *                                     Collision Detection for Non-Convex Polyhedra", 2006).
 *
 * The manifold of that moment goes to the solver as one seen from the start of the step: its separations are larger by what the
 * points close until then, so the ordinary rows stop the bodies at the surface, without a substep of their own. Arms stay those of
 * the impact (setup/contact.h). Bodies that pass each other have no contact that could push them.
 *
 * time_of_impact.h says which contacts ask for it.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H
#define TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H

#include "shared/narrowphase/gjk.h"
#include "shared/narrowphase/time_of_impact.h"

/* A shape of a body that moves evenly. Offsets are seen from the centre of body a at the start. */
typedef struct {
  convex shape; /* at the start, world axes */
  vec3 pivot;   /* centre of the body */
  vec3 linear, angular;
  real radius;  /* that turning swings round; 0 for a sphere in the middle of its body */
} moving_convex;

SHARED moving_convex moving_convex_of(const convex *shape, vec3 pivot, vec3 linear, vec3 angular, real radius)
{
  moving_convex m;
  m.shape = *shape;
  m.pivot = pivot;
  m.linear = linear;
  m.angular = angular;
  m.radius = shape->kind == (uint)SHAPE_SPHERE && length_squared(subtract(shape->center, pivot)) <= R(0.0) ? R(0.0) : radius;
  return m;
}

/* Seen from a point that moves with the velocity `seen_from`: that of body a keeps the numbers near the impact small. */
SHARED convex shape_at(const moving_convex *m, vec3 seen_from, real time)
{
  convex shape = m->shape;
  mat3 turn = turn_within(m->angular, time);
  vec3 pivot = add_scaled(m->pivot, subtract(m->linear, seen_from), time);
  shape.rotation = turned_axes(turn, shape.rotation);
  shape.center = add(pivot, rotate(turn, subtract(shape.center, m->pivot)));
  return shape;
}

/* The speed at which turning brings some part of a shape forward along a unit direction, at most. */
SHARED real swing_along(const moving_convex *m, vec3 direction) { return length_of(outer(m->angular, direction)) * m->radius; }
SHARED real fastest_swing(const moving_convex *m) { return length_of(m->angular) * m->radius; }

/* The first touch of two shapes. */
typedef struct {
  mask hits;   /* they touch at `time`; else not before the horizon */
  real time;   /* s: up to here they do not touch */
  real gap;    /* then; below 0: overlapping */
  vec3 normal; /* then, unit, from a to b */
} impact;

/* The state of a pair after another advance. */
SHARED impact impact_so_far(advancement at, real gap, vec3 normal)
{
  impact so_far = {at.hits, at.time, gap, normal};
  return so_far;
}

SHARED impact first_impact(const moving_convex *a, const moving_convex *b, journey way)
{
  advancement at = start_advancement(1);
  impact met = impact_so_far(at, R(0.0), make_vec3(R(1.0), R(0.0), R(0.0)));
  vec3 approach = subtract(a->linear, b->linear);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && at.active; ++round) {
    convex shape_a = shape_at(a, a->linear, at.time), shape_b = shape_at(b, a->linear, at.time);
    convex_pair pair = pair_of(&shape_a, &shape_b);
    real radii = core_radius(&shape_a) + core_radius(&shape_b);
    gjk_result near = closest_points(&pair.a, &pair.b, way.fastest * (way.horizon - at.time) + radii);
    vec3 along = rotate(pair.axes, near.contact.normal), normal = pair.swapped ? negate(along) : along;
    real gap = (near.overlapping ? R(0.0) : near.contact.gap) - radii;
    at = advanced(at, round, gap, inner(normal, approach) + swing_along(a, normal) + swing_along(b, normal), way);
    met = impact_so_far(at, gap, normal);
  }
  return met;
}

/* The same against all that lies below a plane. up: its unit normal; height: of the plane along it; velocity: of the plane. */
SHARED impact first_impact_on_plane(const moving_convex *body, vec3 up, real height, vec3 velocity, journey way)
{
  advancement at = start_advancement(1);
  impact met = impact_so_far(at, R(0.0), make_vec3(R(1.0), R(0.0), R(0.0)));
  vec3 down = negate(up);
  real rising = inner(up, subtract(velocity, body->linear));
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && at.active; ++round) {
    convex shape = shape_at(body, body->linear, at.time);
    real gap = inner(up, support_of(&shape, down)) - core_radius(&shape) - (height + rising * at.time);
    at = advanced(at, round, gap, rising + swing_along(body, up), way);
    met = impact_so_far(at, gap, down);
  }
  return met;
}

SHARED encounter encounter_at(doubt d, impact met)
{
  encounter e = {met.hits && d.far && met.time > R(0.0), !met.hits, d.swings, met.time};
  return e;
}
SHARED encounter encounter_missed(doubt d)
{
  encounter e = {0, 1, d.swings, R(0.0)};
  return e;
}

/* Follows two shapes in doubt, seen from the centre of the first one's body, and moves them to their impact if their contacts are
 * to be those of that moment. */
SHARED encounter meet(convex *first, convex *second, vec3 offset, pair_motion moves, journey way, doubt d)
{
  if (!d.reached) return encounter_missed(d);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex a = moving_convex_of(first, none, moves.a.linear, moves.a.angular, moves.radius_a);
  moving_convex b = moving_convex_of(second, offset, moves.b.linear, moves.b.angular, moves.radius_b);
  encounter met = encounter_at(d, first_impact(&a, &b, way));
  if (met.at_impact) {
    *first = shape_at(&a, a.linear, met.time);
    *second = shape_at(&b, a.linear, met.time);
  }
  return met;
}

/* The same for a body seen from its own centre above a plane; `height` becomes that of the plane then. */
SHARED encounter meet_plane(convex *shape, vec3 up, real *height, motion body, real radius, motion plane, journey way, doubt d)
{
  if (!d.reached) return encounter_missed(d);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex moving = moving_convex_of(shape, none, body.linear, body.angular, radius);
  encounter met = encounter_at(d, first_impact_on_plane(&moving, up, *height, plane.linear, way));
  if (met.at_impact) {
    *shape = shape_at(&moving, moving.linear, met.time);
    *height = *height - inner(up, subtract(body.linear, plane.linear)) * met.time;
  }
  return met;
}

#endif
