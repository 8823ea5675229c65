/* records.h - the packed fields of body records, and the loads that every stage shares. */
#ifndef TANDEM_SHARED_RECORDS_H
#define TANDEM_SHARED_RECORDS_H

#include "shared/body_codes.h"
#include "shared/counts.h"
#include "shared/features.h"
#include "shared/locks.h"
#include "shared/math.h"
#include "shared/parameters.h"

/* The half extent of an unbounded shape, in metres. */
#define UNBOUNDED R(1e30)

SHARED uint_lanes shape_of(uint_lanes flags) { return flags & 7u; }
/* General shapes have entries in body_convex and body_shape_pose: all but plain spheres, boxes and half-spaces. */
SHARED mask is_general_shape(uint_lanes shape) { return shape > (uint)SHAPE_HALF_SPACE; }
SHARED uint_lanes body_type_of(uint_lanes flags) { return (flags >> 3u) & 3u; }
SHARED uint_lanes is_trigger(uint_lanes flags) { return (flags >> 5u) & 1u; }
SHARED uint_lanes material_of(uint_lanes flags) { return (flags >> 8u) & (MOST_MATERIALS - 1u); }
SHARED mask is_continuous(uint_lanes flags) { return (flags & BODY_FLAG_CONTINUOUS) != 0u; }

/* The shape that takes part in a pair: the body's own, or in scenes with trees one of its children. side: 0 for a, 1
 * for b. */
SHARED uint_lanes shape_in_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf, uint_lanes pair,
                                uint side, uint_lanes body)
{
  return HAS_FEATURE(parameters, TREES) ? load_uint(pair_leaf, pair * 4u + side * 2u) : body;
}

/* A position as the sum of two numbers of one precision, so that a body 1,000 km away still moves by micrometres: `low`
 * is what rounding took from `high` (Dekker, "A floating-point technique for extending the available precision",
 * 1971). */
typedef struct {
  vec3 high, low;
} double_float3;

SHARED double_float3 load_position(GLOBAL const float4 *body_position, uint_lanes body)
{
  double_float3 p = {xyz(load_float4(body_position, body * 2u)), xyz(load_float4(body_position, body * 2u + 1u))};
  return p;
}
SHARED void store_position(GLOBAL float4 *body_position, uint_lanes body, double_float3 p)
{
  store_float4(body_position, body * 2u, extend(p.high, R(0.0)));
  store_float4(body_position, body * 2u + 1u, extend(p.low, R(0.0)));
}

/* The exact difference between a + b and its rounded value `sum` (Knuth's two-sum). */
SHARED vec3 lost_in_sum(vec3 a, vec3 b, vec3 sum)
{
  vec3 from_b = subtract(sum, a), from_a = subtract(sum, from_b);
  return add(subtract(a, from_a), subtract(b, from_b));
}
SHARED double_float3 moved_position(double_float3 p, vec3 by)
{
  vec3 sum = add(p.high, by), low = add(p.low, lost_in_sum(p.high, by, sum));
  double_float3 moved = {add(sum, low), low};
  moved.low = lost_in_sum(sum, low, moved.high);
  return moved;
}

/* The high parts are subtracted first, so that the distance from the origin costs no precision. */
SHARED vec3 way_between(double_float3 from, double_float3 to)
{
  return add(subtract(to.high, from.high), subtract(to.low, from.low));
}
/* The centre of `to` seen from the centre of `from`. */
SHARED vec3 offset_between(GLOBAL const float4 *body_position, uint_lanes from, uint_lanes to)
{
  return way_between(load_position(body_position, from), load_position(body_position, to));
}

/* The smallest half extent of a pair; 0 if neither shape has one (half-spaces, flat meshes). */
SHARED real size_between(GLOBAL const float4 *body_shape, uint_lanes a, uint_lanes b)
{
  vec4 of_a = load_float4(body_shape, a), of_b = load_float4(body_shape, b);
  real size_a = minimum(of_a.x, minimum(of_a.y, of_a.z)), size_b = minimum(of_b.x, minimum(of_b.y, of_b.z));
  return choose(size_a > R(0.0), choose(size_b > R(0.0), minimum(size_a, size_b), size_a), size_b);
}

/* Linear velocity and inverse mass, angular velocity: two float4, one 32-byte record. */
typedef struct {
  vec3 linear, angular;
  real inverse_mass;
  real inverse_inertia; /* of a body whose principal moments are equal; in solver_velocity alone */
} spatial_velocity;

SHARED spatial_velocity velocity_of_float4s(vec4 first, vec4 second)
{
  spatial_velocity m = {xyz(first), xyz(second), first.w, second.w};
  return m;
}
SHARED spatial_velocity load_velocity(GLOBAL const float4 *velocity, uint_lanes body)
{
  return velocity_of_float4s(load_float4(velocity, body * 2u), load_float4(velocity, body * 2u + 1u));
}
/* When two bodies slide past each other, the arm of a follows this share of the sliding, and the arm of b follows the
 * rest. Both arms must end in one point of the world, because an impulse through them would otherwise add angular
 * momentum. A body that cannot move takes the whole; two bodies that can move share it. */
SHARED real share_of_slide(spatial_velocity a, spatial_velocity b)
{
  return choose(a.inverse_mass == R(0.0), (real)R(1.0), choose(b.inverse_mass == R(0.0), (real)R(0.0), (real)R(0.5)));
}

/* The fourth number of manifold_normal is the time of the contacts within the step, s. It is negative where arms that
 * followed the bodies would turn the plane of the contact into something that the contact must leave alone. */
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

/* In a batch each world has its own gravity. Two bodies that meet are of one world, so either tells theirs. */
SHARED vec3 gravity_at(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_gravity, uint_lanes body)
{
  if (HAS_FEATURE(parameters, WORLDS)) return xyz(load_float4(body_gravity, body));
  return gravity_of(parameters);
}

/* The number of a body within its world; its row of gravity has it in a batch. */
SHARED uint_lanes number_in_world(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_gravity,
                                  uint_lanes body)
{
  if (HAS_FEATURE(parameters, WORLDS)) return to_uint(load_float4(body_gravity, body).w);
  return body;
}

/* The first body of a body's world. Of a batch those of one world are neighbours; else all bodies are of one. */
SHARED uint first_of_world(GLOBAL const Parameters *parameters, GLOBAL const uint *body_world, uint body)
{
  return HAS_FEATURE(parameters, WORLDS) ? body_world[2u * body] : 0u;
}

/* A body falls freely if its constraints bear less than this share of its weight (integrate/positions.h). */
#define WEIGHTLESS R(1e-3)

/* The velocity that gravity adds over a step, on average. first, second: rows of body_velocity. */
SHARED vec3 mean_fall(GLOBAL const Parameters *parameters, vec3 gravity, vec4 first, vec4 second)
{
  real factor = choose(first.w > R(0.0), second.w, (real)R(0.0));
  return scale(gravity, factor * R(0.5) * parameters->step);
}
SHARED void store_velocity(GLOBAL float4 *velocity, uint_lanes body, spatial_velocity m)
{
  store_float4(velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_float4(velocity, body * 2u + 1u, extend(m.angular, m.inverse_inertia));
}
SHARED void store_velocity_if(mask wanted, GLOBAL float4 *velocity, uint_lanes body, spatial_velocity m)
{
  store_float4_if(wanted, velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_float4_if(wanted, velocity, body * 2u + 1u, extend(m.angular, m.inverse_inertia));
}

SHARED vec3 velocity_at(spatial_velocity m, vec3 arm) { return add(m.linear, cross3(m.angular, arm)); }

SHARED symmetric3 tensor_of_float4s(vec4 first, vec4 second)
{
  symmetric3 s = {first.x, first.y, first.z, first.w, second.x, second.y};
  return s;
}
SHARED symmetric3 load_tensor(GLOBAL const float4 *inertia, uint_lanes body)
{
  return tensor_of_float4s(load_float4(inertia, body * 2u), load_float4(inertia, body * 2u + 1u));
}
/* The inverse inertia of a body in world axes. Where the principal moments of every body are equal, it is one number,
 * which stands beside the velocity, and the scene has no rows of tensors. The zeros come from memory: a compiler that
 * knew them would decide the signs of the zeros that they are added to. locks: the locked linear axes, the seventh
 * number of a row. */
SHARED symmetric3 load_inertia_and_locks(GLOBAL const Parameters *parameters, GLOBAL const float4 *inertia,
                                         uint_lanes body, spatial_velocity m, real *locks)
{
  real zero = (real)parameters->zero;
  *locks = R(0.0);
  if (HAS_FEATURE(parameters, GYROSCOPIC)) {
    vec4 second = load_float4(inertia, body * 2u + 1u);
    if (MAY_OCCUR(LOCKS)) *locks = second.z;
    return tensor_of_float4s(load_float4(inertia, body * 2u), second);
  } else {
    symmetric3 s = {m.inverse_inertia, m.inverse_inertia, m.inverse_inertia, zero, zero, zero};
    return s;
  }
}
SHARED symmetric3 load_inertia(GLOBAL const Parameters *parameters, GLOBAL const float4 *inertia, uint_lanes body,
                               spatial_velocity m)
{
  real locks;
  return load_inertia_and_locks(parameters, inertia, body, m, &locks);
}
/* The inverse inertia of an orientation, from the principal inverse moments. If these are equal, it is the same for
 * every orientation, without -0 off the diagonal. */
SHARED symmetric3 inertia_of(quat orientation, vec3 inverse_moments)
{
  symmetric3 s = rotate_diagonal(rotation_of(orientation), inverse_moments);
  mask even = (inverse_moments.x == inverse_moments.y) & (inverse_moments.y == inverse_moments.z);
  s.xy = choose(even, (real)R(0.0), s.xy);
  s.xz = choose(even, (real)R(0.0), s.xz);
  s.yz = choose(even, (real)R(0.0), s.yz);
  return s;
}
SHARED void store_inertia(GLOBAL float4 *inertia, uint_lanes body, symmetric3 s)
{
  store_float4(inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_float4(inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}
SHARED void store_inertia_if(mask wanted, GLOBAL float4 *inertia, uint_lanes body, symmetric3 s)
{
  store_float4_if(wanted, inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_float4_if(wanted, inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}

SHARED mask is_nonzero(vec3 v) { return (v.x != R(0.0)) | (v.y != R(0.0)) | (v.z != R(0.0)); }

/* True where every component is a finite number. */
SHARED mask is_finite(vec3 v)
{
  real sum = (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
  return sum == R(0.0);
}

#endif
