/* avbd_rows.h - the rows of joints in augmented vertex block descent (solve/avbd.h); avbd.h has what becomes of their
 * multipliers and penalties.
 *
 * Every direction and rotation that a joint holds is a row, and so is all that an axis limits, drives and brakes:
 *
 *   row                   c, m/s or rad/s                                impulse p
 *   held                  (value - what is left open) / h                lambda - kappa c
 *   limit                 the same, of the way to the limit              the same, on one side alone
 *   motor, friction       speed - target                                 the same, within h times the largest force
 *   largest speed         the speed beyond it                            the same, on one side alone
 *   spring and damper     (h k open + d (speed - target)) / (h k + d)    -(h^2 k + h d) c
 *   soft limit            the same, of the way to the limit              the same, on one side alone
 *
 * Values are those at the end of the substep if both bodies keep their velocities, so rows follow any turn within it.
 * As with contacts, a share of 1 - AVBD_ALPHA of what is open when the substep begins is closed in it; the rest is
 * left. What three held directions leave turns with frame a: the impulse acts on a at the origin of frame b, and only
 * of a gap that turns with a is that the derivative. Joints last, so their multipliers do, too. A spring whose
 * stiffness is above its penalty has a multiplier and the violation c + lambda / (h^2 k + h d), which is 0 where the
 * spring's own law holds.
 *
 * Impulses act along the directions that rows have when the substep begins. With values at its end this is the scheme
 * SHAKE (Ryckaert, Ciccotti and Berendsen, 1977), which keeps energy, and no impulse has an angular momentum. It is
 * explicit in how a push turns with its body, and a light body on which a large force pulls swings too fast for it.
 * There, directions are those at a later share of the substep, `ahead`: from half on any force is stable, and swings
 * are damped. The derivative of the directions is then a part of the body's system; the sizes of its columns are added
 * to the diagonal, as in the paper. That of a distance is known: what moves across it turns its direction by the way
 * over the distance, so a light body between two ropes of a heavy one swings no faster than its substep lets it.
 *
 * A descent along rows whose values change along directions that are off by an angle of a contracts by 2 sin(a / 2) an
 * iteration at best. So rows are `straight` where that is too much: their values follow the velocities as they are. It
 * is so for what bodies that turn far hold, for rotations that are far open, and for an axis which itself turns far,
 * as that of a cone does near 0, and that of a distance which is short.
 */
#ifndef TANDEM_SHARED_JOINTS_AVBD_ROWS_H
#define TANDEM_SHARED_JOINTS_AVBD_ROWS_H

#include "shared/joints/solve.h"
#include "shared/solve/avbd_penalties.h"

#define AVBD_SMALL_TURN R(0.25) /* rad in a substep: a descent along rows that are off by it contracts to a quarter */
#define AVBD_LARGE_TURN R(0.5)  /* from this on, rows are straight */

/* A row at the present velocities. stiffness: of the impulse, kg or kg m^2; holds: nothing bounds its impulse. */
typedef struct {
  real impulse, stiffness, violation;
  uint holds;
} avbd_row;

/* The rows of an axis, which share one Jacobian. turning: how far the direction of a distance turns within the substep
 * for each m/s across it, up to where it is taken, s/m; 0 of others, which do not follow the way across. */
typedef struct {
  axis_row at;
  avbd_row drive, limit, friction, speed;
  real turning;
} avbd_axis;

/* Multipliers, penalties, and what is left open, of the rows of three directions and three rotations. */
typedef struct {
  real multiplier[6], penalty[6], left[6];
} held_rows;

/* A joint when the substep begins, where the directions of its rows are taken, and at the end. ahead: the share of the
 * substep at which these are taken; straight: the share of held values that follow the velocities; time: its length. */
typedef struct {
  joint start, j, end;
  joint_frames start_f, f, end_f;
  real ahead, straight, time;
} avbd_joint;

SHARED joint_side side_after(joint_side s, vec4 local_arm, real time)
{
  s.orientation = turned(s.orientation, scale(s.velocity.angular, time));
  s.translation = add_scaled(s.translation, s.velocity.linear, time);
  s.arm = rotate(rotation_of(s.orientation), xyz(local_arm));
  s.sharing = R(1.0);
  return s;
}

/* A joint as it will be after some time with the present velocities. */
SHARED joint load_joint_after(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                              GLOBAL const float4 *solver_velocity, real time, uint i)
{
  vec4 arm_a = load_float4(joints.arm_a, i), arm_b = load_float4(joints.arm_b, i);
  joint_side a = load_side(parameters, bodies, solver_velocity, load_uint(joints.a, i), arm_a),
             b = load_side(parameters, bodies, solver_velocity, load_uint(joints.b, i), arm_b);
  return joint_between(side_after(a, arm_a, time), side_after(b, arm_b, time), load_uint(joints.modes, i),
                       xyz(load_float4(joints.offset, i)));
}

SHARED avbd_joint load_avbd_joint(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                  GLOBAL const float4 *solver_velocity, real ahead, uint i)
{
  avbd_joint joint;
  real h = parameters->substep;
  joint.start = load_joint_after(parameters, joints, bodies, solver_velocity, R(0.0), i);
  joint.j = joint.start;
  if (ahead > R(0.0)) joint.j = load_joint_after(parameters, joints, bodies, solver_velocity, ahead * h, i);
  real angle = h * maximum(length_of(joint.j.a.velocity.angular), length_of(joint.j.b.velocity.angular));
  joint.straight = clamped((angle - AVBD_SMALL_TURN) / AVBD_SMALL_TURN, R(0.0), R(1.0));
  joint.ahead = ahead;
  joint.end = load_joint_after(parameters, joints, bodies, solver_velocity, h, i);
  joint.start_f = frames_of(parameters, joint.start, joints, i);
  joint.f = frames_of(parameters, joint.j, joints, i);
  joint.end_f = frames_of(parameters, joint.end, joints, i);
  joint.time = h;
  return joint;
}

SHARED void put_three(real *to, vec3 v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
SHARED vec3 take_three(const real *from) { return make_vec3(from[0], from[1], from[2]); }
SHARED real one_of_three(vec3 v, uint k) { return k == 0u ? v.x : k == 1u ? v.y : v.z; }

SHARED held_rows load_held_rows(GLOBAL const Parameters *parameters, read_joint_blocks blocks, uint i)
{
  held_rows rows;
  put_three(rows.multiplier, xyz(load_float4(blocks.linear, i)));
  put_three(rows.penalty, xyz(load_float4(blocks.linear_penalty, i)));
  put_three(rows.left, xyz(load_float4(blocks.linear_left, i)));
  if (!HAS_FEATURE(parameters, JOINT_FRAMES)) return rows;
  put_three(rows.multiplier + 3, xyz(load_float4(blocks.angular, i)));
  put_three(rows.penalty + 3, xyz(load_float4(blocks.angular_penalty, i)));
  put_three(rows.left + 3, xyz(load_float4(blocks.angular_left, i)));
  return rows;
}

SHARED uint holds_row(joint j, uint k) { return (j.modes >> k) & 1u; }

/* Axis k of the frame in which the directions of a joint are held: of the world if all three are. */
SHARED vec3 held_direction(joint j, joint_frames f, uint k)
{
  if ((j.modes & (uint)JOINT_XYZ) == (uint)JOINT_XYZ)
    return make_vec3(k == 0u ? R(1.0) : R(0.0), k == 1u ? R(1.0) : R(0.0), k == 2u ? R(1.0) : R(0.0));
  return k == 0u ? axis_x(f.axes) : k == 1u ? axis_y(f.axes) : axis_z(f.axes);
}

/* Coordinate k of what a joint holds: directions, then rotations. */
SHARED joint_coordinate held_coordinate(joint j, joint_frames f, uint k)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  joint_coordinate at = {R(0.0), none, none};
  if (k < 3u) {
    at.direction = held_direction(j, f, k);
    at.value = dot3(at.direction, j.gap);
  } else {
    at.turn = k == 3u ? axis_x(f.axes) : k == 4u ? axis_y(f.axes) : axis_z(f.axes);
    at.value = one_of_three(turn_between(f.relative, j.modes >> (uint)JOINT_ANGULAR_SHIFT), k - 3u);
  }
  return at;
}

/* The value of a row at the end if its direction stays as it is. */
SHARED real straight_value(const avbd_joint *joint, const axis_row *at)
{
  return at->at.value + (R(1.0) - joint->ahead) * joint->time * at->speed;
}

/* What three directions leave open is in axes of frame a. */
SHARED real row_left(const avbd_joint *joint, joint_frames f, const held_rows *rows, uint k)
{
  if (k < 3u && (joint->j.modes & (uint)JOINT_XYZ) == (uint)JOINT_XYZ)
    return one_of_three(rotate(f.axes, take_three(rows->left)), k);
  return rows->left[k];
}

/* Its value is what is open beyond what may be left. */
SHARED axis_row held_row_of(const avbd_joint *joint, const held_rows *rows, uint k)
{
  axis_row r = row_of_coordinate(joint->j, held_coordinate(joint->j, joint->f, k));
  real straight = straight_value(joint, &r) - row_left(joint, joint->f, rows, k);
  real end = held_coordinate(joint->end, joint->end_f, k).value - row_left(joint, joint->end_f, rows, k);
  real share = k >= 3u && magnitude(rows->left[k]) > AVBD_LARGE_TURN ? R(1.0) : joint->straight;
  r.at.value = end + share * (straight - end);
  return r;
}

/* What a substep leaves of a value that should be 0. */
SHARED real left_open(GLOBAL const Parameters *parameters, real open)
{
  real most = JOINT_CLOSING * parameters->substep;
  return open - clamped((R(1.0) - AVBD_ALPHA) * open, -most, most);
}

SHARED avbd_row no_row(void)
{
  avbd_row r = {R(0.0), R(0.0), R(0.0), 0u};
  return r;
}

SHARED avbd_row held_row(real multiplier, real penalty, real violation)
{
  avbd_row r = {multiplier - penalty * violation, penalty, violation, 1u};
  return r;
}

/* The stiffness of a bounded row is the force that it still bears over its violation. */
SHARED avbd_row bounded_row(avbd_row r, real limit)
{
  real share = share_within(magnitude(r.impulse), limit);
  r.impulse = r.impulse * share;
  r.stiffness = r.stiffness * share;
  r.holds = r.holds != 0u && share == R(1.0) ? 1u : 0u;
  return r;
}

/* A row that pushes up where `below` is negative, and down where `above` is. A row that has just let go may press
 * again, so it stays stiff. */
SHARED avbd_row range_row(real multiplier, real penalty, real below, real above)
{
  real up = maximum(maximum(multiplier, R(0.0)) - penalty * below, R(0.0)),
       down = maximum(maximum(-multiplier, R(0.0)) - penalty * above, R(0.0));
  avbd_row r = no_row();
  r.impulse = up - down;
  r.violation = up > R(0.0) ? below : above;
  r.holds = r.impulse != R(0.0) ? 1u : 0u;
  if (r.holds != 0u || multiplier != R(0.0)) r.stiffness = penalty;
  return r;
}

/* open: how far it is from its rest. */
SHARED avbd_row spring_row(GLOBAL const Parameters *parameters, real multiplier, real penalty, real stiffness,
                           real damping, real open, real speed)
{
  real h = parameters->substep, of_way = h * h * stiffness, of_speed = h * damping, full = of_way + of_speed;
  if (!(full > R(0.0))) return no_row();
  real push = of_way * (open * parameters->inverse_substep) + of_speed * speed;
  if (full > penalty) return held_row(multiplier, penalty, (push + multiplier) / full);
  avbd_row r = {-push, full, R(0.0), 1u};
  return r;
}

SHARED avbd_row drive_row(GLOBAL const Parameters *parameters, const axis_row *r, const joint_axis *axis,
                          real multiplier, real penalty)
{
  real limit = axis->largest_force * parameters->substep;
  if (!(limit > R(0.0))) return no_row();
  if (axis->damping < R(0.0)) {
    real target = clamped(axis->target_speed, -axis->largest_speed, axis->largest_speed);
    return bounded_row(held_row(multiplier, penalty, r->speed - target), limit);
  }
  real open = distance_from(r->at.value, axis->target, is_rotation(axis->kind)), speed = r->speed - axis->target_speed;
  return bounded_row(spring_row(parameters, multiplier, penalty, axis->stiffness, axis->damping, open, speed), limit);
}

SHARED avbd_row friction_row(GLOBAL const Parameters *parameters, const axis_row *r, real friction, real multiplier,
                             real penalty)
{
  if (!(friction > R(0.0))) return no_row();
  return bounded_row(held_row(multiplier, penalty, r->speed), friction * parameters->substep);
}

/* A soft stop from below: it pushes by its spring's law as long as that pushes, whatever side of the stop the present
 * velocities lead to, because its multiplier is what the iterations still have to take back. One that is reached within
 * the substep gives no more than it takes to arrive there. A stop that has just let go stays stiff as in range_row. */
SHARED avbd_row soft_stop_row(GLOBAL const Parameters *parameters, real multiplier, real penalty,
                              const joint_axis *axis, real open, real speed, uint arrives)
{
  real pressing = maximum(multiplier, R(0.0));
  avbd_row r = spring_row(parameters, pressing, penalty, axis->limit_stiffness, axis->limit_damping, open, speed);
  avbd_row arriving = held_row(pressing, penalty, open * parameters->inverse_substep);
  if (arrives != 0u && arriving.impulse < r.impulse) r = arriving;
  if (r.impulse > R(0.0)) return r;
  avbd_row gone = no_row();
  if (pressing > R(0.0)) gone.stiffness = r.stiffness;
  return gone;
}

/* Both stops of a soft range; at most one of them presses once the iterations have converged. */
SHARED avbd_row soft_range_row(avbd_row up, avbd_row down)
{
  avbd_row r = {up.impulse - down.impulse, up.stiffness + down.stiffness,
                up.holds != 0u ? up.violation : down.violation, up.holds | down.holds};
  return r;
}

/* left: how far beyond its limits the coordinate may stay, negative below. */
SHARED avbd_row limit_row(GLOBAL const Parameters *parameters, const axis_row *r, const joint_axis *axis, real left,
                          real multiplier, real penalty)
{
  if (!has_limits(axis, R(0.0))) return no_row();
  real value = value_near_range(r, axis), from_lower = value - axis->lower, to_upper = axis->upper - value;
  uint held = axis->lower == axis->upper, soft = axis->limit_stiffness > R(0.0);
  if (soft && held)
    return spring_row(parameters, multiplier, penalty, axis->limit_stiffness, axis->limit_damping, from_lower,
                      r->speed);
  if (soft) {
    avbd_row up = soft_stop_row(parameters, multiplier, penalty, axis, from_lower, r->speed, left >= R(0.0)),
             down = soft_stop_row(parameters, -multiplier, penalty, axis, to_upper, -r->speed, left <= R(0.0));
    return soft_range_row(up, down);
  }
  if (held) return held_row(multiplier, penalty, (from_lower - left) * parameters->inverse_substep);
  return range_row(multiplier, penalty, (from_lower - minimum(left, R(0.0))) * parameters->inverse_substep,
                   (to_upper + maximum(left, R(0.0))) * parameters->inverse_substep);
}

/* Whether the direction of an axis turns far within the substep, or its rotation does, perhaps by more than a turn. */
SHARED uint turns_far(const avbd_joint *joint, const axis_row *at, joint_coordinate end, uint kind)
{
  real off =
      length_squared(subtract(end.direction, at->at.direction)) + length_squared(subtract(end.turn, at->at.turn));
  uint is_far = is_rotation(kind) && magnitude(joint->time * at->speed) > AVBD_LARGE_TURN ? 1u : 0u;
  return is_far != 0u || off > AVBD_SMALL_TURN * AVBD_SMALL_TURN ? 1u : 0u;
}

SHARED axis_row row_of_avbd_axis(const avbd_joint *joint, uint kind, real *turning)
{
  axis_row at = row_of_axis(joint->j, joint->f, kind);
  joint_coordinate end = coordinate_of(joint->end, joint->end_f, kind);
  *turning = R(0.0);
  if (kind == (uint)JOINT_AXIS_DISTANCE && at.at.value > R(0.0)) *turning = joint->ahead * joint->time / at.at.value;
  if (turns_far(joint, &at, end, kind) != 0u) {
    *turning = R(0.0);
    at = row_of_axis(joint->start, joint->start_f, kind);
    end.value = at.at.value + joint->time * at.speed;
  }
  at.at.value = end.value;
  return at;
}

SHARED avbd_axis avbd_axis_of(GLOBAL const Parameters *parameters, const avbd_joint *joint, const joint_axis *axis,
                              vec4 multiplier, vec4 penalty, real left)
{
  avbd_axis rows;
  rows.at = row_of_avbd_axis(joint, axis->kind, &rows.turning);
  rows.drive = drive_row(parameters, &rows.at, axis, multiplier.x, penalty.x);
  rows.limit = limit_row(parameters, &rows.at, axis, left, multiplier.y, penalty.y);
  rows.friction = friction_row(parameters, &rows.at, axis->friction, multiplier.z, penalty.z);
  rows.speed = no_row();
  real most = axis->largest_speed;
  if (most < UNLIMITED) rows.speed = range_row(multiplier.w, penalty.w, rows.at.speed + most, most - rows.at.speed);
  return rows;
}

SHARED avbd_axis load_avbd_axis(GLOBAL const Parameters *parameters, const avbd_joint *joint, read_joint_blocks blocks,
                                uint k, uint i)
{
  read_joint_axes axes = {blocks.kind, blocks.row};
  joint_axis axis = load_axis(parameters, axes, k, i);
  uint at = joint_plane(parameters, k) + i;
  return avbd_axis_of(parameters, joint, &axis, load_float4(blocks.axis, at), load_float4(blocks.axis_penalty, at),
                      load_real(blocks.axis_left, at));
}

#endif
