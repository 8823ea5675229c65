/* conservative_advancement.h - when two moving shapes meet within the step, and their contact at that moment.
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
 * For bodies that ask for it (TRAIT_CONTINUOUS) and move far within the step; other contacts are those of the start of the step.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H
#define TANDEM_SHARED_NARROWPHASE_CONSERVATIVE_ADVANCEMENT_H

#include "shared/narrowphase/gjk.h"
#include "shared/trigonometry.h"

/* More are needed only where turning swings by a surface that it nearly touches; the contact is then made that much early. */
#define ADVANCEMENT_ROUNDS 48
/* Of the smaller shape's least size: who moves less within the step can neither miss the other nor meet it in a wrong place. */
#define FAR_SHARE R(0.25)
/* Of the least size: shapes this close count as touching. */
#define TOUCHING_SHARE R(1e-3)

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

SHARED mat3 turned_axes(mat3 turn, mat3 axes)
{
  vec3 x = rotate(turn, axis_x(axes)), y = rotate(turn, axis_y(axes)), z = rotate(turn, axis_z(axes));
  mat3 m = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
  return m;
}

/* Seen from a point that moves with the velocity `seen_from`: that of body a keeps the numbers near the impact small. */
SHARED convex shape_at(const moving_convex *m, vec3 seen_from, real time)
{
  convex shape = m->shape;
  mat3 turn = rotation_of(turned(make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), scale(m->angular, time)));
  vec3 pivot = add_scaled(m->pivot, subtract(m->linear, seen_from), time);
  shape.rotation = turned_axes(turn, shape.rotation);
  shape.center = add(pivot, rotate(turn, subtract(shape.center, m->pivot)));
  return shape;
}

/* The speed at which turning brings some part of a shape forward along a unit direction, at most. */
SHARED real swing_along(const moving_convex *m, vec3 direction) { return length_of(outer(m->angular, direction)) * m->radius; }
SHARED real fastest_swing(const moving_convex *m) { return length_of(m->angular) * m->radius; }

typedef struct {
  mask hits;   /* they touch at `time`; else not before the horizon */
  real time;   /* s: up to here they do not touch */
  real gap;    /* then; below 0: overlapping */
  vec3 normal; /* then, unit, from a to b */
} impact;

/* How far to look, and from which gap on shapes touch. */
typedef struct { real horizon, touching, fastest; } journey;

SHARED journey journey_of(real fastest, real horizon, real least, real size)
{
  journey way = {horizon, maximum(TOUCHING_SHARE * least, R(16.0) * ROUNDING * (fastest * horizon + size)), fastest};
  return way;
}

/* Advances by what the gap allows at this closing speed. False where that ends the journey. */
SHARED mask advanced(impact *at, journey way, real closing)
{
  at->hits = at->gap <= way.touching;
  if (at->hits || closing <= R(0.0) || at->gap > way.fastest * (way.horizon - at->time)) return 0;
  real next = at->time + (at->gap - R(0.5) * way.touching) / closing;
  if (!(next < way.horizon)) return 0;
  at->time = next;
  return 1;
}

SHARED impact first_impact(const moving_convex *a, const moving_convex *b, journey way)
{
  impact at = {0, R(0.0), R(0.0), {R(1.0), R(0.0), R(0.0)}};
  vec3 approach = subtract(a->linear, b->linear);
  for (int round = 0; round < ADVANCEMENT_ROUNDS; ++round) {
    convex shape_a = shape_at(a, a->linear, at.time), shape_b = shape_at(b, a->linear, at.time);
    convex_pair pair = pair_of(&shape_a, &shape_b);
    real radii = core_radius(&shape_a) + core_radius(&shape_b);
    gjk_result near = closest_points(&pair.a, &pair.b, way.fastest * (way.horizon - at.time) + radii);
    vec3 normal = rotate(pair.axes, near.contact.normal);
    at.normal = pair.swapped ? negate(normal) : normal;
    at.gap = (near.overlapping ? R(0.0) : near.contact.gap) - radii;
    if (!advanced(&at, way, inner(at.normal, approach) + swing_along(a, at.normal) + swing_along(b, at.normal))) return at;
  }
  at.hits = 1;
  return at;
}

/* The same against all that lies below a plane. up: its unit normal; height: of the plane along it; velocity: of the plane. */
SHARED impact first_impact_on_plane(const moving_convex *body, vec3 up, real height, vec3 velocity, journey way)
{
  impact at = {0, R(0.0), R(0.0), negate(up)};
  real rising = inner(up, subtract(velocity, body->linear));
  for (int round = 0; round < ADVANCEMENT_ROUNDS; ++round) {
    convex shape = shape_at(body, body->linear, at.time);
    at.gap = inner(up, support_of(&shape, at.normal)) - core_radius(&shape) - (height + rising * at.time);
    if (!advanced(&at, way, rising + swing_along(body, up))) return at;
  }
  at.hits = 1;
  return at;
}

/* What the narrowphase does with a pair. */
enum { CONTACT_AT_START, CONTACT_AT_IMPACT, CONTACT_MISSED };

typedef struct {
  int kind;
  real time; /* of the impact, s */
} encounter;

SHARED encounter encounter_of(impact at)
{
  encounter met = {at.hits ? (at.time > R(0.0) ? CONTACT_AT_IMPACT : CONTACT_AT_START) : CONTACT_MISSED, at.hits ? at.time : R(0.0)};
  return met;
}

/* Contacts are made somewhat ahead of touching, for what gravity and other contacts add: the way is followed past the end of the
 * step until it has grown by that distance. */
SHARED real horizon_of(GLOBAL const Parameters *parameters, real fastest) { return parameters->step + parameters->speculative_distance / fastest; }
SHARED mask moves_far(GLOBAL const Parameters *parameters, real fastest, real least) { return fastest * parameters->step > FAR_SHARE * least; }

/* Moves both to their impact, if there is one within the step. */
SHARED encounter meet(GLOBAL const Parameters *parameters, convex *first, convex *second, vec3 pivot, motion motion_a, real radius_a, motion motion_b,
                      real radius_b)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex a = moving_convex_of(first, none, motion_a.linear, motion_a.angular, radius_a);
  moving_convex b = moving_convex_of(second, pivot, motion_b.linear, motion_b.angular, radius_b);
  real fastest = length_of(subtract(motion_a.linear, motion_b.linear)) + fastest_swing(&a) + fastest_swing(&b);
  real least = minimum(least_size(first), least_size(second));
  encounter met = {CONTACT_AT_START, R(0.0)};
  if (!moves_far(parameters, fastest, least)) return met;
  met = encounter_of(first_impact(&a, &b, journey_of(fastest, horizon_of(parameters, fastest), least, bounding_radius_of(first) + bounding_radius_of(second))));
  if (met.kind == CONTACT_AT_IMPACT) {
    *first = shape_at(&a, a.linear, met.time);
    *second = shape_at(&b, a.linear, met.time);
  }
  return met;
}

/* The same for a body seen from its own centre above a plane; `height` becomes that of the plane then. */
SHARED encounter meet_plane(GLOBAL const Parameters *parameters, convex *shape, vec3 up, real *height, motion body, real radius, motion plane)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  moving_convex moving = moving_convex_of(shape, none, body.linear, body.angular, radius);
  vec3 approach = subtract(body.linear, plane.linear);
  real fastest = length_of(approach) + fastest_swing(&moving);
  encounter met = {CONTACT_AT_START, R(0.0)};
  if (!moves_far(parameters, fastest, least_size(shape))) return met;
  journey way = journey_of(fastest, horizon_of(parameters, fastest), least_size(shape), bounding_radius_of(shape));
  met = encounter_of(first_impact_on_plane(&moving, up, *height, plane.linear, way));
  if (met.kind == CONTACT_AT_IMPACT) {
    *shape = shape_at(&moving, moving.linear, met.time);
    *height = *height - inner(up, approach) * met.time;
  }
  return met;
}

/* From the moment of the impact back to the start of the step: points were as far apart again as they close until then. A point
 * that parts was not nearer before: what turns does not move on a line. Bodies that miss each other keep, of the contacts at the start, those
 * that their own motion does not reach. offset: centre of b from that of a, then. */
SHARED manifold as_seen_from_start(manifold m, encounter met, vec3 offset, motion a, motion b, real step)
{
  for (int slot = 0; slot < 4; ++slot) {
    vec3 arm = xyz(m.point[slot]);
    real closing = maximum(inner(m.normal, subtract(velocity_at(a, arm), velocity_at(b, subtract(arm, offset)))), R(0.0));
    if (met.kind == CONTACT_MISSED) m.kept[slot] = m.kept[slot] & (closing * step < m.point[slot].w);
    else m.point[slot].w = m.point[slot].w + closing * met.time;
  }
  return m;
}

/* Kept beside the normal, for the set-up. */
SHARED void store_impact_time(GLOBAL row *normals, uint i, real time)
{
  vec3 normal = xyz(load_row(normals, i));
  if (length_squared(normal) > R(0.0)) store_row(normals, i, extend(normal, time));
}

#endif
