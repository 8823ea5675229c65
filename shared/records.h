/* records.h - the packed fields of body records, and the loads that every stage shares. */
#ifndef TANDEM_SHARED_RECORDS_H
#define TANDEM_SHARED_RECORDS_H

#include "shared/body_codes.h"
#include "shared/counts.h"
#include "shared/features.h"
#include "shared/math.h"
#include "shared/parameters.h"

/* Half extent of what has no end, in metres. */
#define BOUNDLESS R(1e30)

SHARED natural shape_of(natural traits) { return traits & 7u; }
/* Shapes that body_convex and body_shape_pose tell more of: neither sphere, box nor half-space, or no plain one. */
SHARED mask is_general_shape(natural shape) { return shape > (uint)SHAPE_HALF_SPACE; }
SHARED natural motion_of(natural traits) { return (traits >> 3u) & 3u; }
SHARED natural is_trigger(natural traits) { return (traits >> 5u) & 1u; }
SHARED natural material_of(natural traits) { return (traits >> 8u) & (MOST_MATERIALS - 1u); }
SHARED mask is_continuous(natural traits) { return (traits & TRAIT_CONTINUOUS) != 0u; }

/* The shape that takes part in a pair: the body's own, or in scenes with trees one of its children. side: 0 for a, 1
 * for b. */
SHARED natural shape_in_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf, natural pair, uint side,
                             natural body)
{
  return HAS_FEATURE(parameters, TREES) ? load_natural(pair_leaf, pair * 4u + side * 2u) : body;
}

/* A position as the sum of two numbers of one precision, so that a body 1,000 km away still moves by micrometres: `low`
 * is what rounding took from `high` (Dekker, "A floating-point technique for extending the available precision",
 * 1971). */
typedef struct {
  vec3 high, low;
} place;

SHARED place load_place(GLOBAL const row *body_position, natural body)
{
  place p = {xyz(load_row(body_position, body * 2u)), xyz(load_row(body_position, body * 2u + 1u))};
  return p;
}
SHARED void store_place(GLOBAL row *body_position, natural body, place p)
{
  store_row(body_position, body * 2u, extend(p.high, R(0.0)));
  store_row(body_position, body * 2u + 1u, extend(p.low, R(0.0)));
}

/* What a + b lost when it became `sum`, exactly (Knuth's two-sum). */
SHARED vec3 lost_in_sum(vec3 a, vec3 b, vec3 sum)
{
  vec3 from_b = subtract(sum, a), from_a = subtract(sum, from_b);
  return add(subtract(a, from_a), subtract(b, from_b));
}
SHARED place moved_place(place p, vec3 by)
{
  vec3 sum = add(p.high, by), low = add(p.low, lost_in_sum(p.high, by, sum));
  place moved = {add(sum, low), low};
  moved.low = lost_in_sum(sum, low, moved.high);
  return moved;
}

/* The centre of `to` seen from that of `from`: differences first, so that far away costs nothing. */
SHARED vec3 offset_between(GLOBAL const row *body_position, natural from, natural to)
{
  place a = load_place(body_position, from), b = load_place(body_position, to);
  return add(subtract(b.high, a.high), subtract(b.low, a.low));
}

/* The smallest half extent of a pair; of two that have none (half-spaces, flat meshes), 0. */
SHARED real size_between(GLOBAL const row *body_shape, natural a, natural b)
{
  vec4 of_a = load_row(body_shape, a), of_b = load_row(body_shape, b);
  real size_a = minimum(of_a.x, minimum(of_a.y, of_a.z)), size_b = minimum(of_b.x, minimum(of_b.y, of_b.z));
  return choose(size_a > R(0.0), choose(size_b > R(0.0), minimum(size_a, size_b), size_a), size_b);
}

/* Linear velocity and inverse mass, angular velocity: two rows, one 32-byte record. */
typedef struct {
  vec3 linear, angular;
  real inverse_mass;
} motion;

SHARED motion motion_of_rows(vec4 first, vec4 second)
{
  motion m = {xyz(first), xyz(second), first.w};
  return m;
}
SHARED motion load_motion(GLOBAL const row *velocity, natural body)
{
  return motion_of_rows(load_row(velocity, body * 2u), load_row(velocity, body * 2u + 1u));
}
/* Which share of what two bodies slide past each other the arm of a follows; that of b follows the rest. Arms must end
 * in one point of the world, or an impulse through them adds angular momentum: a body that cannot move takes the whole,
 * two that can share it. */
SHARED real share_of_slide(motion a, motion b)
{
  return choose(a.inverse_mass == R(0.0), (real)R(1.0), choose(b.inverse_mass == R(0.0), (real)R(0.0), (real)R(0.5)));
}

/* What manifold_normal keeps beside the normal: the moment of the contacts, s of the step; below 0 where arms that
 * followed the bodies would turn the plane of the contact into what it was to leave alone. */
#define LEAST_MOMENT R(1e-12)
SHARED real packed_moment(real time, mask arms_stay)
{
  return choose(arms_stay, R(0.0) - maximum(time, LEAST_MOMENT), time);
}
SHARED real moment_of(real packed) { return magnitude(packed); }
SHARED mask keeps_arms(real packed) { return packed < R(0.0); }

SHARED vec3 gravity_of(GLOBAL const Parameters *parameters)
{
  return make_vec3(parameters->gravity_x, parameters->gravity_y, parameters->gravity_z);
}

/* Of its weight: constraints that bear less leave a body to fall (integrate/positions.h). */
#define WEIGHTLESS R(1e-3)

/* The velocity that gravity adds over a step, on average. first, second: rows of body_velocity. */
SHARED vec3 mean_fall(GLOBAL const Parameters *parameters, vec4 first, vec4 second)
{
  real factor = choose(first.w > R(0.0), second.w, (real)R(0.0));
  return scale(gravity_of(parameters), factor * R(0.5) * parameters->step);
}
SHARED void store_motion(GLOBAL row *velocity, natural body, motion m)
{
  store_row(velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_row(velocity, body * 2u + 1u, extend(m.angular, R(0.0)));
}
SHARED void store_motion_if(mask wanted, GLOBAL row *velocity, natural body, motion m)
{
  store_row_if(wanted, velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_row_if(wanted, velocity, body * 2u + 1u, extend(m.angular, R(0.0)));
}

SHARED vec3 velocity_at(motion m, vec3 arm) { return add(m.linear, outer(m.angular, arm)); }

SHARED symmetric3 load_inertia(GLOBAL const row *inertia, natural body)
{
  vec4 first = load_row(inertia, body * 2u), second = load_row(inertia, body * 2u + 1u);
  symmetric3 s = {first.x, first.y, first.z, first.w, second.x, second.y};
  return s;
}
SHARED void store_inertia(GLOBAL row *inertia, natural body, symmetric3 s)
{
  store_row(inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_row(inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}
SHARED void store_inertia_if(mask wanted, GLOBAL row *inertia, natural body, symmetric3 s)
{
  store_row_if(wanted, inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_row_if(wanted, inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}

/* True where every component is a finite number. */
SHARED mask is_finite(vec3 v)
{
  real sum = (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
  return sum == R(0.0);
}

#endif
