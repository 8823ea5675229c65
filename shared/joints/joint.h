/* joint.h - a joint with its bodies and frames as they are now, and the response of the two bodies to its impulses.
 *
 *                     arm_a            gap              arm_b
 *     (centre of a)---------->(frame a)---->(frame b)<--------(centre of b)
 *
 * Impulses act on both bodies at the origin of frame b, so they add no angular momentum, however far the frames are
 * apart. The side of a joint that is the world has no body; its frame stands in the world.
 */
#ifndef TANDEM_SHARED_JOINTS_JOINT_H
#define TANDEM_SHARED_JOINTS_JOINT_H

#include "shared/argument_groups.h"
#include "shared/joints/joint_codes.h"
#include "shared/records.h"
#include "shared/substep_classes.h"

/* body: of a side that is the world, any that exists. */
typedef struct {
  uint_lanes body;
  mask is_world;
  spatial_velocity velocity;
  symmetric3 inertia;
  real locks;   /* linear, as in solver_inertia */
  real sharing; /* the body seems lighter to each of its joints by this factor */
  quat orientation;
  vec3 translation; /* since the step began, m */
  vec3 arm;         /* from the centre of the body to the point at which impulses act, m */
} joint_side;

typedef struct {
  joint_side a, b;
  uint_lanes modes;
  vec3 gap; /* from frame a to frame b, m */
} joint;

SHARED uint_lanes body_of_side(uint_lanes given)
{
  return MAY_OCCUR(JOINTS_TO_WORLD) ? choose(given == (uint_lanes)INDEX_NONE, (uint_lanes)0u, given) : given;
}

SHARED symmetric3 without_response(mask m, symmetric3 s)
{
  symmetric3 r = {zero_if(m, s.xx), zero_if(m, s.yy), zero_if(m, s.zz),
                  zero_if(m, s.xy), zero_if(m, s.xz), zero_if(m, s.yz)};
  return r;
}

/* The world is at rest, and no impulse moves it. */
SHARED joint_side world_if(mask m, joint_side s)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  s.velocity.linear = choose3(m, none, s.velocity.linear);
  s.velocity.angular = choose3(m, none, s.velocity.angular);
  s.velocity.inverse_mass = zero_if(m, s.velocity.inverse_mass);
  s.inertia = without_response(m, s.inertia);
  s.locks = zero_if(m, s.locks);
  s.orientation = quat_from(choose4(m, make_vec4(R(0.0), R(0.0), R(0.0), R(1.0)), quat_to_vec4(s.orientation)));
  s.translation = choose3(m, none, s.translation);
  return s;
}

/* local_arm: of the frame's origin, in the body's axes. */
SHARED joint_side load_side(GLOBAL const Parameters *parameters, read_turning_bodies bodies,
                            GLOBAL const float4 *solver_velocity, uint_lanes body, vec4 local_arm)
{
  joint_side s;
  s.body = body_of_side(body);
  s.is_world = body == (uint_lanes)INDEX_NONE;
  s.velocity = load_velocity(solver_velocity, s.body);
  s.inertia = load_inertia_and_locks(parameters, bodies.inertia, s.body, s.velocity, &s.locks);
  s.orientation = quat_from(load_float4(bodies.orientation, s.body));
  s.translation = xyz(load_float4(bodies.delta, s.body * 2u));
  if (MAY_OCCUR(JOINTS_TO_WORLD) && any_of(s.is_world)) s = world_if(s.is_world, s);
  s.arm = rotate(rotation_of(s.orientation), xyz(local_arm));
  s.sharing = local_arm.w;
  return s;
}

/* offset: between the two centres when the step began. */
SHARED joint joint_between(joint_side a, joint_side b, uint_lanes modes, vec3 offset)
{
  joint j = {a, b, modes, offset};
  vec3 apart = add(offset, subtract(j.b.translation, j.a.translation));
  vec3 at_b = add(apart, j.b.arm); /* frame b, seen from the centre of a */
  j.gap = subtract(at_b, j.a.arm);
  j.a.arm = at_b;
  return j;
}

SHARED uint_lanes class_of_side(read_turning_bodies bodies, uint_lanes given)
{
  uint_lanes own = load_uint(bodies.substep_class, body_of_side(given));
  return choose(given == (uint_lanes)INDEX_NONE, (uint_lanes)NO_CLASS, own);
}

/* a, b: as the joint has them. */
SHARED uint_lanes class_of_joint(read_turning_bodies bodies, uint_lanes a, uint_lanes b)
{
  return larger_class(class_of_side(bodies, a), class_of_side(bodies, b));
}

/* A joint of the other class is one of the world with itself that holds nothing, so that the pass changes neither its
 * impulses nor its bodies. */
SHARED joint left_out_if(mask m, joint j)
{
  j.a = world_if(m, j.a);
  j.b = world_if(m, j.b);
  j.a.is_world = j.a.is_world | m;
  j.b.is_world = j.b.is_world | m;
  j.modes = choose(m, (uint_lanes)0u, j.modes);
  return j;
}

SHARED mask is_left_out(const joint *j) { return j->a.is_world & j->b.is_world; }

/* Of a pass over one class of bodies. */
SHARED mask is_joint_of_pass(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                             item_index i)
{
  return is_of_pass(parameters, class_of_joint(bodies, load_uint(joints.a, i), load_uint(joints.b, i)));
}

/* Whether the pass leaves out the joints of all lanes. */
SHARED uint leaves_out(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                       item_index i)
{
  return moves_one_class(parameters) && !any_of(is_joint_of_pass(parameters, joints, bodies, i)) ? 1u : 0u;
}

SHARED joint load_joint(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                        GLOBAL const float4 *solver_velocity, item_index i)
{
  joint_side a = load_side(parameters, bodies, solver_velocity, load_uint(joints.a, i), load_float4(joints.arm_a, i)),
             b = load_side(parameters, bodies, solver_velocity, load_uint(joints.b, i), load_float4(joints.arm_b, i));
  joint j = joint_between(a, b, load_uint(joints.modes, i), xyz(load_float4(joints.offset, i)));
  if (moves_one_class(parameters)) j = left_out_if(!is_joint_of_pass(parameters, joints, bodies, i), j);
  return j;
}

/* Bodies that cannot move are never written, because joints of one colour share them. */
SHARED void store_joint_velocities(GLOBAL float4 *solver_velocity, joint j)
{
  store_velocity_if(j.a.velocity.inverse_mass > R(0.0), solver_velocity, j.a.body, j.a.velocity);
  store_velocity_if(j.b.velocity.inverse_mass > R(0.0), solver_velocity, j.b.body, j.b.velocity);
}

SHARED void push_side(joint_side *s, vec3 impulse, vec3 moment, real sign)
{
  s->velocity.linear = pushed(s->velocity.linear, s->locks, impulse, sign * s->velocity.inverse_mass);
  s->velocity.angular = add_scaled(s->velocity.angular, symmetric_times(s->inertia, moment), sign);
}

/* An impulse on b at the origin of frame b; a gets the opposite. */
SHARED joint apply_at_frame(joint j, vec3 impulse)
{
  push_side(&j.a, impulse, cross3(j.a.arm, impulse), R(-1.0));
  push_side(&j.b, impulse, cross3(j.b.arm, impulse), R(1.0));
  return j;
}

/* A part of a joint that some lanes lack leaves their velocities alone: adding 0 would turn -0 into +0. */
SHARED joint with_joint_velocities_if(mask wanted, joint j, joint moved)
{
  j.a.velocity.linear = choose3(wanted, moved.a.velocity.linear, j.a.velocity.linear);
  j.a.velocity.angular = choose3(wanted, moved.a.velocity.angular, j.a.velocity.angular);
  j.b.velocity.linear = choose3(wanted, moved.b.velocity.linear, j.b.velocity.linear);
  j.b.velocity.angular = choose3(wanted, moved.b.velocity.angular, j.b.velocity.angular);
  return j;
}

SHARED vec3 closing_velocity(joint j)
{
  return subtract(velocity_at(j.b.velocity, j.b.arm), velocity_at(j.a.velocity, j.a.arm));
}

SHARED symmetric3 scaled_tensor(symmetric3 s, real k)
{
  symmetric3 r = {k * s.xx, k * s.yy, k * s.zz, k * s.xy, k * s.xz, k * s.yz};
  return r;
}

/* The velocity at the end of the arm along the axis `row` that a unit impulse along the axis `column` gives there. */
SHARED symmetric3 response_of_side(joint_side s)
{
  real m = s.velocity.inverse_mass;
  vec3 x = make_vec3(R(0.0), s.arm.z, -s.arm.y), y = make_vec3(-s.arm.z, R(0.0), s.arm.x),
       z = make_vec3(s.arm.y, -s.arm.x, R(0.0));
  vec3 from_x = symmetric_times(s.inertia, x), from_y = symmetric_times(s.inertia, y),
       from_z = symmetric_times(s.inertia, z);
  vec3 mass = make_vec3(m, m, m);
  if (MAY_OCCUR(LOCKS) && any_of(s.locks > R(0.0))) mass = without_locked_axes(mass, to_uint(s.locks));
  symmetric3 k = {mass.x + dot3(x, from_x), mass.y + dot3(y, from_y), mass.z + dot3(z, from_z),
                  dot3(x, from_y),          dot3(x, from_z),          dot3(y, from_z)};
  return scaled_tensor(k, s.sharing);
}

SHARED symmetric3 add_symmetric(symmetric3 a, symmetric3 b)
{
  symmetric3 s = {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  return s;
}

#endif
