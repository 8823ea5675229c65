/* axes.h - limits, springs, motors and friction of the free coordinates of a joint.
 *
 *   lower            target          upper        m or rad
 *     |<-- limit ------/\/\/-- drive --->|        drive: force = stiffness (target - x) + damping (target speed - v),
 *                                                 within its largest force; friction: at most so much, against v
 *
 * Springs are implicit in velocity and position, so they are stable at any stiffness: with h the substep, k stiffness
 * and c damping, the impulse p satisfies v + p / (h (c + h k)) + (k (x - target) - c v_target) / (c + h k) = 0
 * (Catto, "Soft Constraints", GDC 2011). x is the coordinate at the start of the substep in all of its passes.
 *
 * All rows of a coordinate have one Jacobian, so they are solved one after another as numbers, and their sum is applied
 * to the bodies once.
 */
#ifndef TANDEM_SHARED_JOINTS_AXES_H
#define TANDEM_SHARED_JOINTS_AXES_H

#include "shared/joints/coordinates.h"
#include "shared/joints/softness.h"
#include "shared/solve/pass.h"

/* Joints close no faster than this, m/s and rad/s. Bodies that begin far from where a joint wants them would otherwise
 * arrive with the energy of a bullet. */
#define JOINT_CLOSING R(10.0)
#define LEAST_LEAK R(0.2) /* the share of the leak that is left where closing is limited (soft_rows_of) */

#define HALF_TURN R(3.14159265)
/* Beyond this, in m or rad, m/s or rad/s, nothing is a limit. */
#define UNLIMITED R(1e18)

/* The row of an axis. */
typedef struct {
  uint_lanes kind;
  real lower, upper, target, target_speed;
  real stiffness, damping, largest_force, friction;
  real limit_stiffness, limit_damping, largest_speed, restitution;
} joint_axis;

/* Axis k of all joints is a plane of kinds, and three of numbers. */
SHARED uint joint_plane(GLOBAL const Parameters *parameters, uint k) { return k * parameters->joints; }

SHARED joint_axis load_axis(GLOBAL const Parameters *parameters, read_joint_axes axes, uint k, item_index i)
{
  vec4 range = load_float4(axes.row, joint_plane(parameters, 3u * k) + i),
       drive = load_float4(axes.row, joint_plane(parameters, 3u * k + 1u) + i),
       limit = load_float4(axes.row, joint_plane(parameters, 3u * k + 2u) + i);
  joint_axis a = {load_uint(axes.kind, joint_plane(parameters, k) + i),
                  range.x,
                  range.y,
                  range.z,
                  range.w,
                  drive.x,
                  drive.y,
                  drive.z,
                  drive.w,
                  limit.x,
                  limit.y,
                  limit.z,
                  limit.w};
  return a;
}

/* A coordinate with what its rows share. moment: of a unit impulse, about the centre of each body. */
typedef struct {
  joint_coordinate at;
  vec3 moment_a, moment_b;
  real response, shared_response, mass, speed;
  real leak;    /* of soft rows, as a share of that of whole bodies: joints/mass_split.h */
  mask crowded; /* whether a body gives way to many joints: joints/softness.h */
} axis_row;

SHARED real response_along(joint_side s, vec3 direction, vec3 moment)
{
  vec3 pushes = direction;
  if (MAY_OCCUR(LOCKS) && any_of(s.locks > R(0.0))) pushes = without_locked_axes(pushes, to_uint(s.locks));
  return s.velocity.inverse_mass * dot3(pushes, direction) + dot3(moment, symmetric_times(s.inertia, moment));
}

SHARED axis_row row_of_coordinate(joint j, joint_coordinate at)
{
  axis_row r;
  r.at = at;
  r.leak = R(1.0);
  r.crowded = is_crowded(&j);
  r.moment_a = add(cross3(j.a.arm, r.at.direction), r.at.turn);
  r.moment_b = add(cross3(j.b.arm, r.at.direction), r.at.turn);
  real of_a = response_along(j.a, r.at.direction, r.moment_a), of_b = response_along(j.b, r.at.direction, r.moment_b);
  r.response = of_a + of_b;
  r.shared_response = j.a.sharing * of_a + j.b.sharing * of_b;
  mask moves = r.shared_response > R(0.0);
  r.mass = choose(moves, R(1.0) / choose(moves, r.shared_response, (real)R(1.0)), (real)R(0.0));
  r.speed = dot3(r.at.direction, subtract(j.b.velocity.linear, j.a.velocity.linear)) +
            dot3(r.moment_b, j.b.velocity.angular) - dot3(r.moment_a, j.a.velocity.angular);
  return r;
}

SHARED axis_row row_of_axis(joint j, joint_frames f, uint_lanes kind)
{
  return row_of_coordinate(j, coordinate_of(j, f, kind));
}

/* The change of the impulse `old` of a spring. open: how far it is from its rest. */
SHARED real spring_change(GLOBAL const Parameters *parameters, const axis_row *r, real stiffness, real damping,
                          real open, real target_speed, real old)
{
  real h = parameters->substep, sum = damping + h * stiffness;
  mask acts = (sum > R(0.0)) & (r->mass > R(0.0));
  real divisor = choose(acts, sum, (real)R(1.0));
  real gamma = parameters->inverse_substep / divisor, bias = (stiffness * open - damping * target_speed) / divisor;
  real change = R(0.0) - (r->speed + bias + gamma * old) / (choose(acts, r->shared_response, (real)R(1.0)) + gamma);
  return choose(acts, change, (real)R(0.0));
}

/* Takes the new impulse of a row, if it is there, and adds its change to the speed and to the sum of all rows. A row
 * that is not there must not add 0, which would turn -0 into +0. */
SHARED real take_impulse_if(mask wanted, axis_row *r, real old, real impulse, real *sum)
{
  real change = impulse - old;
  r->speed = choose(wanted, r->speed + r->response * change, r->speed);
  *sum = choose(wanted, *sum + change, *sum);
  return choose(wanted, impulse, old);
}

/* An angle that differs from a target by more than half a turn is nearer to it the other way round. */
SHARED real distance_from(real value, real target, mask turns)
{
  real apart = value - target;
  return choose(turns, apart - R(2.0) * HALF_TURN * nearest_integer(apart / (R(2.0) * HALF_TURN)), apart);
}

/* old: the impulse that the drive has, of an axis that may have lost it. */
SHARED mask has_drive(const joint_axis *axis, real old)
{
  return (axis->stiffness != R(0.0)) | (axis->damping != R(0.0)) | (old != R(0.0));
}
SHARED mask has_limits(const joint_axis *axis, real old)
{
  return (axis->lower > -UNLIMITED) | (axis->upper < UNLIMITED) | (old != R(0.0));
}

SHARED real solve_drive(GLOBAL const Parameters *parameters, axis_row *r, const joint_axis *axis, real start, real old,
                        real *sum)
{
  mask wanted = has_drive(axis, old);
  if (!any_of(wanted)) return old;
  real open = distance_from(start, axis->target, is_rotation(axis->kind)),
       limit = axis->largest_force * parameters->substep;
  mask rigid = axis->damping < R(0.0);
  real change =
      spring_change(parameters, r, axis->stiffness, maximum(axis->damping, R(0.0)), open, axis->target_speed, old);
  change = choose(rigid, r->mass * (axis->target_speed - r->speed), change);
  return take_impulse_if(wanted, r, old, clamped(old + change, -limit, limit), sum);
}

SHARED real solve_axis_friction(GLOBAL const Parameters *parameters, axis_row *r, real friction, real old, real *sum)
{
  mask wanted = (friction > R(0.0)) | (old != R(0.0));
  real limit = friction * parameters->substep;
  return take_impulse_if(wanted, r, old, clamped(old - r->mass * r->speed, -limit, limit), sum);
}

/* The share of a closing speed that is not too fast. */
SHARED real share_of_closing(real speed)
{
  real size = magnitude(speed);
  mask limited = size > JOINT_CLOSING;
  return choose(limited, JOINT_CLOSING / choose(limited, size, (real)R(1.0)), (real)R(1.0));
}

/* The change of the impulse of a stop. open: the way that is left, negative beyond it. In a relaxing pass, the motion
 * that a stop ahead would limit comes later. */
SHARED real stop_change(GLOBAL const Parameters *parameters, const axis_row *r, real open, real old, uint pass)
{
  mask ahead = open > R(0.0);
  if (pass != PASS_BIASED) {
    real relaxed = R(0.0) - r->mass * (r->speed + choose(ahead, open * parameters->inverse_substep, (real)R(0.0)));
    return choose(ahead & (old == R(0.0)), (real)R(0.0), relaxed);
  }
  joint_softness soft = joint_softness_of(parameters, r->crowded);
  real push = soft.bias_rate * open, limited = share_of_closing(push);
  real bias = choose(ahead, open * parameters->inverse_substep, push * limited);
  real share = choose(ahead, (real)R(1.0), soft.mass_scale),
       leak = choose(ahead, (real)R(0.0), soft.impulse_scale * maximum(limited, LEAST_LEAK));
  return R(0.0) - r->mass * share * (r->speed + bias) - leak * r->leak * old;
}

/* The same of a coordinate that is held in place. open: how far it is from there. */
SHARED real hold_change(GLOBAL const Parameters *parameters, const axis_row *r, real open, real old, uint pass)
{
  if (pass != PASS_BIASED) return R(0.0) - r->mass * r->speed;
  joint_softness soft = joint_softness_of(parameters, r->crowded);
  real push = soft.bias_rate * open, limited = share_of_closing(push);
  return R(0.0) - r->mass * soft.mass_scale * (r->speed + push * limited) -
         soft.impulse_scale * maximum(limited, LEAST_LEAK) * r->leak * old;
}

/* The coordinate as it is nearest to the range; a full turn more or less is the same angle. */
SHARED real value_near_range(const axis_row *r, const joint_axis *axis)
{
  real middle = R(0.5) * (axis->lower + axis->upper);
  mask turns = is_rotation(axis->kind) & (magnitude(middle) < R(2.0) * HALF_TURN);
  real near = choose(turns, middle, (real)R(0.0));
  return choose(turns, near + distance_from(r->at.value, near, turns), r->at.value);
}

/* The change of the impulse of a soft stop. One that is ahead gives no more than it takes to arrive there at the end of
 * the substep, because its damper begins where its spring does. */
SHARED real soft_stop_change(GLOBAL const Parameters *parameters, const axis_row *r, const joint_axis *axis, real open,
                             mask held, real old)
{
  real change = spring_change(parameters, r, axis->limit_stiffness, axis->limit_damping, open, R(0.0), old);
  real arriving = R(0.0) - r->mass * (r->speed + open * parameters->inverse_substep);
  return choose((open > R(0.0)) & !held, minimum(change, arriving), change);
}

/* One limit, from below; the new impulse pushes the coordinate up. held: from above as well. */
SHARED real solve_stop(GLOBAL const Parameters *parameters, axis_row *r, const joint_axis *axis, real open, mask held,
                       real old, uint pass)
{
  real change = stop_change(parameters, r, open, old, pass);
  change = choose(held, hold_change(parameters, r, open, old, pass), change);
  mask springy = axis->limit_stiffness > R(0.0);
  if (any_of(springy)) change = choose(springy, soft_stop_change(parameters, r, axis, open, held, old), change);
  real impulse = old + change;
  impulse = choose(held, impulse, maximum(impulse, R(0.0)));
  r->speed = r->speed + r->response * (impulse - old);
  return impulse;
}

/* One impulse for both limits, positive from the lower one. A range of 0 holds the coordinate in place. The upper limit
 * is a lower one of the coordinate's opposite. */
SHARED real solve_limits(GLOBAL const Parameters *parameters, axis_row *r, const joint_axis *axis, real old, uint pass,
                         real *sum)
{
  mask wanted = has_limits(axis, old);
  if (!any_of(wanted)) return old;
  real speed_before = r->speed;
  real value = value_near_range(r, axis);
  mask held = axis->lower == axis->upper, never = held & !held;
  real lower = choose(held, old, maximum(old, R(0.0))), upper = choose(held, (real)R(0.0), maximum(-old, R(0.0)));
  lower = solve_stop(parameters, r, axis, value - axis->lower, held, lower, pass);
  axis_row opposite = *r;
  opposite.speed = -r->speed;
  real from_upper = solve_stop(parameters, &opposite, axis, axis->upper - value, never, upper, pass);
  from_upper = choose(held, (real)R(0.0), from_upper);
  real impulse = lower - from_upper;
  r->speed = choose(wanted, r->speed - r->response * (from_upper - upper), speed_before);
  *sum = choose(wanted, *sum + (impulse - old), *sum);
  return choose(wanted, impulse, old);
}

/* What is too fast is braked, by an impulse that no pass keeps. */
SHARED void limit_speed(axis_row *r, real largest, real *sum)
{
  mask is_fast = magnitude(r->speed) > largest;
  real change = r->mass * (clamped(r->speed, -largest, largest) - r->speed);
  r->speed = choose(is_fast, r->speed + r->response * change, r->speed);
  *sum = choose(is_fast, *sum + change, *sum);
}

SHARED joint apply_along(joint j, const axis_row *r, real impulse)
{
  push_side(&j.a, scale(r->at.direction, impulse), scale(r->moment_a, impulse), R(-1.0));
  push_side(&j.b, scale(r->at.direction, impulse), scale(r->moment_b, impulse), R(1.0));
  return j;
}

/* The sum by which the impulses of an axis change. kept: those of drive, limits and friction, and the coordinate at the
 * start of the substep. */
SHARED real solve_rows_of_axis(GLOBAL const Parameters *parameters, axis_row *r, const joint_axis *axis, vec4 *kept,
                               uint pass)
{
  real start = pass == PASS_BIASED ? r->at.value : kept->w, sum = R(0.0);
  real drive = solve_drive(parameters, r, axis, start, kept->x, &sum);
  real friction = solve_axis_friction(parameters, r, axis->friction, kept->z, &sum);
  limit_speed(r, axis->largest_speed, &sum);
  real limit = solve_limits(parameters, r, axis, kept->y, pass, &sum);
  *kept = make_vec4(drive, limit, friction, start);
  return sum;
}

SHARED joint solve_axis(GLOBAL const Parameters *parameters, joint j, joint_frames f, const joint_axis *axis,
                        vec4 *kept, uint pass)
{
  axis_row r = row_of_axis(j, f, axis->kind);
  real sum = solve_rows_of_axis(parameters, &r, axis, kept, pass);
  return apply_along(j, &r, sum);
}

SHARED joint solve_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                        GLOBAL float4 *impulse, uint pass, item_index i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    mask wanted = axis.kind != (uint_lanes)(uint)JOINT_AXIS_NONE;
    if (moves_one_class(parameters)) wanted = wanted & !is_left_out(&j);
    if (!any_of(wanted)) continue;
    vec4 kept = load_float4(impulse, joint_plane(parameters, k) + i);
    j = with_joint_velocities_if(wanted, j, solve_axis(parameters, j, f, &axis, &kept, pass));
    store_float4_if(wanted, impulse, joint_plane(parameters, k) + i, kept);
  }
  return j;
}

/* What a joint gives its bodies, in axes of the world: an impulse at frame b, and its moments about both centres. */
typedef struct {
  vec3 impulse, moment_a, moment_b;
} joint_wrench;

SHARED joint_wrench with_wrench_of_axis(joint j, joint_frames f, uint_lanes kind, real sum, joint_wrench w)
{
  mask wanted = kind != (uint_lanes)(uint)JOINT_AXIS_NONE;
  if (!any_of(wanted)) return w;
  axis_row r = row_of_axis(j, f, kind);
  w.impulse = choose3(wanted, add_scaled(w.impulse, r.at.direction, sum), w.impulse);
  w.moment_a = choose3(wanted, add_scaled(w.moment_a, r.moment_a, sum), w.moment_a);
  w.moment_b = choose3(wanted, add_scaled(w.moment_b, r.moment_b, sum), w.moment_b);
  return w;
}

SHARED joint_wrench with_wrench_of_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f,
                                        read_joint_axes axes, GLOBAL const float4 *impulse, joint_wrench w,
                                        item_index i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    vec4 kept = load_float4(impulse, joint_plane(parameters, k) + i);
    w = with_wrench_of_axis(j, f, load_uint(axes.kind, joint_plane(parameters, k) + i), (kept.x + kept.y) + kept.z, w);
  }
  return w;
}

#endif
