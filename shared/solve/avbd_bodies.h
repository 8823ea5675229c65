/* avbd_bodies.h - augmented vertex block descent: one body against all its constraints and joints; see avbd.h and
 * joints/avbd_rows.h.
 *
 * The solver makes a Newton step on the six velocities of a body, in coordinates y = M^(1/2) (w - v*) with angles along
 * its principal axes:
 *
 *   (1 + sum kappa j j^T) dy = -y + sum j p      j = M^(-1/2) J: the row of a constraint, p: its impulse
 *
 * The matrix is the unit matrix plus a positive semidefinite one, so pivots are at least 1 whatever the masses, and an
 * infinite moment of inertia gives a row of zeros. The factorisation L D L^T of its 21 numbers is written out.
 */
#ifndef TANDEM_SHARED_SOLVE_AVBD_BODIES_H
#define TANDEM_SHARED_SOLVE_AVBD_BODIES_H

#include "shared/joints/avbd_rows.h"
#include "shared/solve/avbd.h"

/* The lower triangle, row by row, and the right-hand side. */
typedef struct {
  real matrix[21], vector[6];
} block_system;

/* The transformation of a constraint row into the body's own coordinates. side: -1 for body a, 1 for b. */
typedef struct {
  mat3 axes;
  vec3 root_moments; /* of the inverse */
  real root_mass, side;
} block_frame;

SHARED real over_or_zero(real x, real divisor)
{
  return choose(divisor > R(0.0), x / choose(divisor > R(0.0), divisor, (real)R(1.0)), (real)R(0.0));
}

/* zero: a 0 from memory, because llvmpipe simplifies 0 + x to x, also for -0. */
SHARED block_system begin_block(block_frame frame, spatial_velocity m, spatial_velocity target, real zero)
{
  block_system s;
  vec3 linear = subtract(m.linear, target.linear),
       angular = rotate_back(frame.axes, subtract(m.angular, target.angular));
  for (uint k = 0; k < 21u; ++k) s.matrix[k] = zero;
  for (uint k = 0; k < 6u; ++k) s.matrix[k * (k + 3u) / 2u] = R(1.0);
  s.vector[0] = -over_or_zero(linear.x, frame.root_mass);
  s.vector[1] = -over_or_zero(linear.y, frame.root_mass);
  s.vector[2] = -over_or_zero(linear.z, frame.root_mass);
  s.vector[3] = -over_or_zero(angular.x, frame.root_moments.x);
  s.vector[4] = -over_or_zero(angular.y, frame.root_moments.y);
  s.vector[5] = -over_or_zero(angular.z, frame.root_moments.z);
  return s;
}

/* Adds the coordinates `first` to 5 of a row. */
SHARED void add_row_from(block_system *s, uint first, const real *j, real stiffness, real impulse)
{
  for (uint r = first; r < 6u; ++r) {
    real stiff = stiffness * j[r];
    for (uint k = first; k <= r; ++k)
      s->matrix[r * (r + 1u) / 2u + k] = s->matrix[r * (r + 1u) / 2u + k] + stiff * j[k];
    s->vector[r] = s->vector[r] + impulse * j[r];
  }
}

SHARED void add_row(block_system *s, block_frame frame, vec3 direction, vec3 turn, real stiffness, real impulse)
{
  vec3 push = scale(direction, frame.side * frame.root_mass);
  vec3 twist = scale(multiply(rotate_back(frame.axes, turn), frame.root_moments), frame.side);
  real j[6] = {push.x, push.y, push.z, twist.x, twist.y, twist.z};
  add_row_from(s, 0u, j, stiffness, impulse);
}

/* Adds a row that only turns the body. */
SHARED void add_turning_row(block_system *s, block_frame frame, vec3 turn, real stiffness, real impulse)
{
  vec3 twist = scale(multiply(rotate_back(frame.axes, turn), frame.root_moments), frame.side);
  real j[6] = {twist.x, twist.x, twist.x, twist.x, twist.y, twist.z};
  add_row_from(s, 3u, j, stiffness, impulse);
}

/* Factorises L D L^T in place, and replaces the right-hand side by the solution. Rounding cannot take a pivot below 1,
 * because terms are only added to it. */
SHARED void solve_block(block_system *s)
{
  real *m = s->matrix, *v = s->vector;
  real inverse[6];
  for (uint k = 0; k < 6u; ++k) {
    inverse[k] = R(1.0) / maximum(m[k * (k + 3u) / 2u], R(1.0));
    for (uint r = k + 1u; r < 6u; ++r) {
      real factor = m[r * (r + 1u) / 2u + k] * inverse[k];
      for (uint q = k + 1u; q <= r; ++q)
        m[r * (r + 1u) / 2u + q] = m[r * (r + 1u) / 2u + q] - factor * m[q * (q + 1u) / 2u + k];
      v[r] = v[r] - factor * v[k];
    }
  }
  for (uint n = 0; n < 6u; ++n) {
    uint k = 5u - n;
    for (uint r = k + 1u; r < 6u; ++r) v[k] = v[k] - m[r * (r + 1u) / 2u + k] * v[r];
    v[k] = v[k] * inverse[k];
  }
}

SHARED void add_contact(block_system *s, block_frame frame, GLOBAL const float4 *constraint_normal_impulse,
                        GLOBAL const float4 *constraint_penalty, contact c, contact_forces f, uint constraint)
{
  vec4 penalty = load_float4(constraint_penalty, constraint * 2u),
       friction_penalty = load_float4(constraint_penalty, constraint * 2u + 1u);
  vec4 multipliers = load_float4(constraint_normal_impulse, constraint);
  real held = R(0.0);
  for (uint k = 0; k < 4u; ++k) {
    if (f.impulse[k] > R(0.0) ||
        component(multipliers, k) > R(0.0)) /* a point that has just parted may press again, so it stays stiff */
      add_row(s, frame, c.normal, frame.side > R(0.0) ? f.r_cross_n_b[k] : f.r_cross_n_a[k], component(penalty, k),
              f.impulse[k]);
    held = held + f.impulse[k];
  }
  if (c.friction == R(0.0) || held == R(0.0)) return;
  vec3 arm = frame.side > R(0.0) ? f.arm_b : f.arm_a;
  real stiffness = friction_penalty.x * f.slide_share;
  add_row(s, frame, f.along.first, cross3(arm, f.along.first), stiffness, f.first);
  add_row(s, frame, f.along.second, cross3(arm, f.along.second), stiffness, f.second);
  add_turning_row(s, frame, c.normal, friction_penalty.y * f.twist_share, f.twist);
}

/* The rows of an axis have one Jacobian. */
SHARED void add_joint_row(block_system *s, block_frame frame, const axis_row *at, avbd_row r)
{
  if (!(r.stiffness > R(0.0))) return;
  vec3 moment = frame.side > R(0.0) ? at->moment_b : at->moment_a;
  add_row(s, frame, at->at.direction, moment, r.stiffness, r.impulse);
}

/* A push along a distance turns with what moves across it; of a push apart, too, the size is added. */
SHARED void add_turning_distance(block_system *s, block_frame frame, const avbd_joint *joint, const avbd_axis *rows,
                                 real zero)
{
  real stiffness = rows->turning * magnitude(rows->limit.impulse + rows->drive.impulse);
  if (!(stiffness > R(0.0))) return;
  vec3 arm = frame.side > R(0.0) ? joint->j.b.arm : subtract(joint->j.a.arm, joint->j.gap);
  tangents across = tangents_of(rows->at.at.direction);
  add_row(s, frame, across.first, cross3(arm, across.first), stiffness, zero);
  add_row(s, frame, across.second, cross3(arm, across.second), stiffness, zero);
}

SHARED void add_held_rows(block_system *s, block_frame frame, GLOBAL const Parameters *parameters,
                          const avbd_joint *joint, const held_rows *rows, vec3 *push)
{
  for (uint k = 0; k < (HAS_FEATURE(parameters, JOINT_FRAMES) ? 6u : 3u); ++k) {
    if (!holds_row(joint->j, k)) continue;
    axis_row at = held_row_of(joint, rows, k);
    avbd_row r = held_row(rows->multiplier[k], rows->penalty[k], at.at.value * parameters->inverse_substep);
    add_joint_row(s, frame, &at, r);
    *push = add_scaled(*push, at.at.direction, r.impulse);
  }
}

SHARED void add_axes(block_system *s, block_frame frame, GLOBAL const Parameters *parameters, const avbd_joint *joint,
                     read_joint_blocks blocks, vec3 *push, uint i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    if (load_uint(blocks.kind, joint_plane(parameters, k) + i) == (uint)JOINT_AXIS_NONE) continue;
    avbd_axis rows = load_avbd_axis(parameters, joint, blocks, k, i);
    add_joint_row(s, frame, &rows.at, rows.drive);
    add_joint_row(s, frame, &rows.at, rows.limit);
    add_joint_row(s, frame, &rows.at, rows.friction);
    add_joint_row(s, frame, &rows.at, rows.speed);
    add_turning_distance(s, frame, joint, &rows, (real)parameters->zero);
    *push = add_scaled(*push, rows.at.at.direction, rows.limit.impulse);
    *push = add_scaled(*push, rows.at.at.direction, rows.drive.impulse);
  }
}

/* The moment of a push at the end of an arm changes as the body turns by an angle d: d (push . arm) - arm (push . d).
 * Of the symmetric part of this matrix, in the coordinates of the system, the sizes of the columns are added. */
SHARED void add_turning_arm(block_system *s, block_frame frame, vec3 arm, vec3 push, real time)
{
  vec3 r = rotate_back(frame.axes, arm), p = scale(rotate_back(frame.axes, push), frame.side * time),
       m = frame.root_moments;
  real along = dot3(r, p), xy = R(-0.5) * (r.x * p.y + r.y * p.x) * m.x * m.y,
       xz = R(-0.5) * (r.x * p.z + r.z * p.x) * m.x * m.z, yz = R(-0.5) * (r.y * p.z + r.z * p.y) * m.y * m.z;
  real xx = (along - r.x * p.x) * m.x * m.x, yy = (along - r.y * p.y) * m.y * m.y, zz = (along - r.z * p.z) * m.z * m.z;
  s->matrix[9] = s->matrix[9] + length_of(make_vec3(xx, xy, xz));
  s->matrix[14] = s->matrix[14] + length_of(make_vec3(xy, yy, yz));
  s->matrix[20] = s->matrix[20] + length_of(make_vec3(xz, yz, zz));
}

SHARED void add_joint(block_system *s, block_frame frame, GLOBAL const Parameters *parameters, read_joints joints,
                      read_turning_bodies bodies, read_joint_blocks blocks, GLOBAL const float4 *solver_velocity,
                      uint i)
{
  avbd_joint joint =
      load_avbd_joint(parameters, joints, bodies, solver_velocity, load_float4(blocks.linear_left, i).w, i);
  held_rows rows = load_held_rows(parameters, blocks, i);
  vec3 push = make_vec3((real)parameters->zero, (real)parameters->zero, (real)parameters->zero);
  add_held_rows(s, frame, parameters, &joint, &rows, &push);
  if (HAS_FEATURE(parameters, JOINT_AXES)) add_axes(s, frame, parameters, &joint, blocks, &push, i);
  add_turning_arm(s, frame, frame.side > R(0.0) ? joint.j.b.arm : joint.j.a.arm, push,
                  joint.ahead * parameters->substep);
}

/* The share of a Newton step that a body with joints makes: a step may stop its turn, or add AVBD_LARGE_TURN, beyond
 * which its rows are others. */
SHARED real share_of_step(GLOBAL const Parameters *parameters, vec3 angular, vec3 turn)
{
  return share_within(length_of(turn), maximum(AVBD_LARGE_TURN * parameters->inverse_substep, length_of(angular)));
}

SHARED void avbd_body(GLOBAL const Parameters *parameters, read_blocks blocks, read_contacts contacts,
                      read_patches patches, read_duals duals, read_body_lists lists, read_joints joints,
                      read_joint_blocks joint_blocks, GLOBAL const uint *counts, GLOBAL float4 *solver_velocity,
                      uint body)
{
  point_planes planes = planes_of(counts);
  spatial_velocity m = load_velocity(solver_velocity, body);
  vec3 inverse_moments = xyz(load_float4(blocks.mass, body));
  block_frame frame = {
      rotation_of(quat_from(load_float4(blocks.orientation, body))),
      make_vec3(square_root(inverse_moments.x), square_root(inverse_moments.y), square_root(inverse_moments.z)),
      square_root(m.inverse_mass), R(1.0)};
  block_system s = begin_block(frame, m, load_velocity(blocks.target, body), (real)parameters->zero);
  for (uint k = lists.start[body]; k < lists.start[body + 1u]; ++k) {
    uint entry = lists.entries[k], i = entry >> 1u;
    frame.side = (entry & 1u) != 0u ? R(1.0) : R(-1.0);
    contact c = load_contact(parameters, contacts, solver_velocity, blocks.inertia, i);
    add_contact(&s, frame, duals.normal, duals.penalty, c,
                forces_of(parameters, patches, duals.normal, duals.friction, duals.penalty, blocks.delta, planes, c, i),
                i);
  }
  if (HAS_FEATURE(parameters, JOINTS)) {
    read_turning_bodies bodies = {blocks.inertia, blocks.delta, blocks.orientation, 0};
    for (uint k = lists.joint_start[body]; k < lists.joint_start[body + 1u]; ++k) {
      uint entry = lists.joint_entries[k];
      frame.side = (entry & 1u) != 0u ? R(1.0) : R(-1.0);
      add_joint(&s, frame, parameters, joints, bodies, joint_blocks, solver_velocity, entry >> 1u);
    }
  }
  solve_block(&s);
  vec3 push = scale(make_vec3(s.vector[0], s.vector[1], s.vector[2]), frame.root_mass),
       turn = rotate(frame.axes, multiply(frame.root_moments, make_vec3(s.vector[3], s.vector[4], s.vector[5])));
  if (HAS_FEATURE(parameters, JOINTS) && lists.joint_start[body] != lists.joint_start[body + 1u]) {
    real share = share_of_step(parameters, m.angular, turn);
    push = scale(push, share);
    turn = scale(turn, share);
  }
  m.linear = add(m.linear, push);
  m.angular = add(m.angular, turn);
  store_velocity(solver_velocity, body, m);
}

/* Solves the bodies of one colour at once. */
SHARED void avbd_bodies_item(GLOBAL const Parameters *parameters, read_blocks blocks, read_contacts contacts,
                             read_patches patches, read_duals duals, read_body_lists lists, read_joints joints,
                             read_joint_blocks joint_blocks, GLOBAL const uint *counts, GLOBAL float4 *solver_velocity,
                             uint i)
{
  avbd_body(parameters, blocks, contacts, patches, duals, lists, joints, joint_blocks, counts, solver_velocity,
            blocks.order[i]);
}

/* One item solves the bodies from this colour on in order: those of colours that the host did not launch, and those of
 * the overflow colour. Bodies of one colour share no constraint, so the result is that of launching each colour. */
SHARED void avbd_rest_item(GLOBAL const Parameters *parameters, read_blocks blocks, read_contacts contacts,
                           read_patches patches, read_duals duals, read_body_lists lists, read_joints joints,
                           read_joint_blocks joint_blocks, GLOBAL const uint *counts, GLOBAL float4 *solver_velocity,
                           uint color, uint only)
{
  (void)only;
  for (uint i = counts[BODY_COLOR_START + color]; i < counts[BODY_COLOR_START + COLOR_OVERFLOW + 1u]; ++i)
    avbd_body(parameters, blocks, contacts, patches, duals, lists, joints, joint_blocks, counts, solver_velocity,
              blocks.order[i]);
}

#endif
