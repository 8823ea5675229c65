/* relative.h - the two bodies of a contact as one: the body that is seen, as it moves for the one that sees it.
 *
 *        other             Impulses act on both at one place, in opposite directions. So rows of the contact see one
 *          o--.            velocity, that of the seen body less that of the other one, and one inverse inertia, with
 *              \ arms      which that velocity answers to an impulse on the seen body. Both belong to its centre.
 *      seen o---*
 *
 * The seen body is a link, so that its centre is near, however large the other one is.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_RELATIVE_H
#define TANDEM_SHARED_ARTICULATIONS_RELATIVE_H

#include "shared/articulations/side.h"

typedef struct {
  mask is_b;    /* b is seen; else a is */
  vec3 to_seen; /* from the centre of the other body */
  spatial_motion velocity;
  symmetric6 inverse;   /* how pushes change the velocity, as inverse_times wants it */
  symmetric6 response;  /* the same or more, for the effective masses of rows */
  spatial_force pushed; /* the seen body, since the velocity was loaded */
} relative_body;

/* between: from the centre of a to that of b. */
SHARED relative_body relative_body_of(mask is_b, vec3 between)
{
  relative_body r;
  r.is_b = is_b;
  r.to_seen = choose3(is_b, between, negate(between));
  r.velocity = no_motion();
  r.inverse = r.response = zero_symmetric6();
  r.pushed = no_force();
  return r;
}

/* Motions of the two bodies, or rows of them. */
SHARED spatial_motion motion_seen(const relative_body *r, spatial_motion seen, spatial_motion other)
{
  spatial_motion carried = motion_at(other, r->to_seen);
  spatial_motion m = {subtract(seen.angular, carried.angular), subtract(seen.linear, carried.linear)};
  return m;
}

/* What pushes the other body while f pushes the one that is seen. */
SHARED spatial_force push_back(const relative_body *r, spatial_force f)
{
  return scaled_force(force_at(f, negate(r->to_seen)), R(-1.0));
}

/* A unit impulse on b along a direction, and its opposite on a; with the arm of the body that is seen. */
SHARED spatial_force row_seen(const relative_body *r, vec3 arm_a, vec3 arm_b, vec3 direction)
{
  return impulse_at(choose3(r->is_b, arm_b, arm_a), choose3(r->is_b, direction, negate(direction)));
}
SHARED spatial_force twist_seen(const relative_body *r, vec3 axis)
{
  return twist_about(choose3(r->is_b, axis, negate(axis)));
}

/* How fast it moves along `second` by an impulse along `first`, or less fast. */
SHARED real response_seen(const relative_body *r, spatial_force first, spatial_force second)
{
  return power_of(second, inverse_times(&r->response, first));
}

SHARED void push_seen(relative_body *r, spatial_force impulse)
{
  r->velocity = add_motions(r->velocity, inverse_times(&r->inverse, impulse));
  r->pushed = add_forces(r->pushed, impulse);
}

/* The velocity and pushes of one, and those of another. */
SHARED relative_body choose_relative(mask m, relative_body a, relative_body b)
{
  b.velocity = choose_motion(m, a.velocity, b.velocity);
  b.pushed = choose_force(m, a.pushed, b.pushed);
  return b;
}

#endif
