/* locks.h - axes of the world along or about which a body does not move (Body::linear_locks and angular_locks).
 *
 *   body_lock  --lock_bodies-->  solver_inertia: the inverse inertia, and beside it the locked linear axes
 *
 * An impulse meets an infinite mass along a locked linear axis. A torque meets an infinite moment about a locked
 * angular one: the inverse inertia is that of a body whose axis is held, with rows of exact zeros. Solvers take both
 * from solver_inertia, so effective masses, impulses and warm starts agree, and what is locked is 0 at all times, not
 * only at the end of a substep. In a scene without locks no kernel of them runs, and a device builds none of this.
 */
#ifndef TANDEM_SHARED_LOCKS_H
#define TANDEM_SHARED_LOCKS_H

#include "shared/body_codes.h"
#include "shared/features.h"
#include "shared/math.h"

SHARED real zero_if(mask m, real x) { return choose(m, (real)R(0.0), x); }

/* The vector without its components along locked axes; locks: bits LOCK_X, LOCK_Y, LOCK_Z. */
SHARED vec3 without_locked_axes(vec3 v, uint_lanes locks)
{
  return make_vec3(zero_if((locks & (uint)LOCK_X) != 0u, v.x), zero_if((locks & (uint)LOCK_Y) != 0u, v.y),
                   zero_if((locks & (uint)LOCK_Z) != 0u, v.z));
}

/* v + direction * factor along the axes that are free; v has no component along the others. locks: the seventh number
 * of solver_inertia. */
SHARED vec3 pushed(vec3 v, real locks, vec3 direction, real factor)
{
  vec3 result = add_scaled(v, direction, factor);
  if (MAY_OCCUR(LOCKS) && any_of(locks > R(0.0))) result = without_locked_axes(result, to_uint(locks));
  return result;
}

/* The inverse inertia of a body that is held about one axis: the response to a torque, and to the torque with which the
 * holder answers so that the body does not turn about the axis (a Schur complement). */
SHARED real held_share(real own)
{
  return choose(own > R(0.0), R(1.0) / choose(own > R(0.0), own, (real)R(1.0)), (real)R(0.0));
}
SHARED symmetric3 held_about_x(symmetric3 a)
{
  real s = held_share(a.xx), zero = R(0.0);
  symmetric3 r = {zero,
                  maximum(a.yy - a.xy * a.xy * s, zero),
                  maximum(a.zz - a.xz * a.xz * s, zero),
                  zero,
                  zero,
                  a.yz - a.xy * a.xz * s};
  return r;
}
SHARED symmetric3 held_about_y(symmetric3 a)
{
  real s = held_share(a.yy), zero = R(0.0);
  symmetric3 r = {maximum(a.xx - a.xy * a.xy * s, zero),
                  zero,
                  maximum(a.zz - a.yz * a.yz * s, zero),
                  zero,
                  a.xz - a.xy * a.yz * s,
                  zero};
  return r;
}
SHARED symmetric3 held_about_z(symmetric3 a)
{
  real s = held_share(a.zz), zero = R(0.0);
  symmetric3 r = {maximum(a.xx - a.xz * a.xz * s, zero),
                  maximum(a.yy - a.yz * a.yz * s, zero),
                  zero,
                  a.xy - a.xz * a.yz * s,
                  zero,
                  zero};
  return r;
}

SHARED symmetric3 choose_symmetric(mask m, symmetric3 a, symmetric3 b)
{
  symmetric3 r = {choose(m, a.xx, b.xx), choose(m, a.yy, b.yy), choose(m, a.zz, b.zz),
                  choose(m, a.xy, b.xy), choose(m, a.xz, b.xz), choose(m, a.yz, b.yz)};
  return r;
}

/* locks: bits LOCK_X, LOCK_Y, LOCK_Z. */
SHARED symmetric3 held_about_axes(symmetric3 a, uint_lanes locks)
{
  a = choose_symmetric((locks & (uint)LOCK_X) != 0u, held_about_x(a), a);
  a = choose_symmetric((locks & (uint)LOCK_Y) != 0u, held_about_y(a), a);
  return choose_symmetric((locks & (uint)LOCK_Z) != 0u, held_about_z(a), a);
}

/* The two halves of body_lock. */
SHARED uint_lanes linear_locks(uint_lanes body_lock) { return body_lock & (uint)(LOCK_X | LOCK_Y | LOCK_Z); }
SHARED uint_lanes angular_locks(uint_lanes body_lock) { return body_lock >> (uint)LOCK_ANGULAR_SHIFT; }

#endif
