/* nncg.h - joints in the conjugate gradients of solve/nncg.h: their impulses go on along the direction, too.
 *
 * All rows of a joint are one block of the preconditioner, so the square of a change is the energy that the change
 * would give the two bodies of the joint, were there no other: for each body, impulse^2 / mass and moment . inertia^-1
 * moment. Couplings take part in the passes alone.
 *
 * A joint has these rows: linear and angular impulse, and for each axis those of drive, limits and friction. The fourth
 * number of an axis is where it was when the substep began, which no direction changes.
 */
#ifndef TANDEM_SHARED_JOINTS_NNCG_H
#define TANDEM_SHARED_JOINTS_NNCG_H

#include "shared/joints/solve.h"
#include "shared/solve/nncg_state.h"

/* Rows of nncg_joint, and parts of nncg_joint_axis: first the impulses before a pass, then the direction. */
#define NNCG_LINEAR 0u
#define NNCG_ANGULAR 1u
#define NNCG_DIRECTION 2u

SHARED item_index nncg_row(GLOBAL const Parameters *parameters, uint row, item_index i)
{
  return row * parameters->joints + i;
}

SHARED item_index nncg_axis_row(GLOBAL const Parameters *parameters, uint k, item_index i)
{
  return (parameters->joint_axes + k) * parameters->joints + i;
}

SHARED joint_impulses between_impulses(joint_impulses before, joint_impulses now)
{
  joint_impulses change = {subtract(now.linear, before.linear), subtract(now.angular, before.angular)};
  return change;
}

/* The impulses before the pass. */
SHARED joint_impulses load_before(GLOBAL const Parameters *parameters, GLOBAL const float4 *nncg_joint, item_index i)
{
  joint_impulses before = {xyz(load_float4(nncg_joint, nncg_row(parameters, NNCG_LINEAR, i))),
                           make_vec3(R(0.0), R(0.0), R(0.0))};
  if (HAS_FEATURE(parameters, JOINT_FRAMES))
    before.angular = xyz(load_float4(nncg_joint, nncg_row(parameters, NNCG_ANGULAR, i)));
  return before;
}

/* Before the first pass there is neither a change nor a direction. */
SHARED void nncg_begin_joints_item(GLOBAL const Parameters *parameters, read_joint_impulses impulses,
                                   GLOBAL float4 *nncg_joint, GLOBAL float4 *nncg_joint_axis, item_index i)
{
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(nncg_joint, nncg_row(parameters, NNCG_LINEAR, i), load_float4(impulses.linear, i));
  store_float4(nncg_joint, nncg_row(parameters, NNCG_DIRECTION + NNCG_LINEAR, i), zero);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    store_float4(nncg_joint, nncg_row(parameters, NNCG_ANGULAR, i), load_float4(impulses.angular, i));
    store_float4(nncg_joint, nncg_row(parameters, NNCG_DIRECTION + NNCG_ANGULAR, i), zero);
  }
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    item_index at = joint_plane(parameters, k) + i;
    store_float4(nncg_joint_axis, at, load_float4(impulses.axis, at));
    store_float4(nncg_joint_axis, nncg_axis_row(parameters, k, i), zero);
  }
}

SHARED real energy_of_side(joint_side s, vec3 impulse, vec3 moment)
{
  return s.sharing * response_along(s, impulse, moment);
}

/* The sum of what an axis changed by, of drive, limits and friction. */
SHARED real sum_of_change(vec4 before, vec4 now)
{
  return ((now.x - before.x) + (now.y - before.y)) + (now.z - before.z);
}

SHARED joint_wrench with_changed_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f,
                                      read_joint_axes axes, GLOBAL const float4 *impulse,
                                      GLOBAL const float4 *nncg_joint_axis, joint_wrench w, item_index i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    item_index at = joint_plane(parameters, k) + i;
    w = with_wrench_of_axis(j, f, load_uint(axes.kind, at),
                            sum_of_change(load_float4(nncg_joint_axis, at), load_float4(impulse, at)), w);
  }
  return w;
}

/* Computes, after a pass, the square of its change of this joint. */
SHARED void nncg_change_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                    read_joint_axes axes, read_joint_impulses impulses, GLOBAL const float4 *nncg_joint,
                                    GLOBAL const float4 *nncg_joint_axis, GLOBAL const float4 *solver_velocity,
                                    GLOBAL memory_real *nncg_joint_square, item_index i)
{
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_impulses now = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
  joint_wrench w = joint_wrench_of(parameters, j, f, between_impulses(load_before(parameters, nncg_joint, i), now));
  if (HAS_FEATURE(parameters, JOINT_AXES))
    w = with_changed_axes(parameters, j, f, axes, impulses.axis, nncg_joint_axis, w, i);
  store_real(nncg_joint_square, i,
             energy_of_side(j.a, w.impulse, w.moment_a) + energy_of_side(j.b, w.impulse, w.moment_b));
}

/* The step along a direction of a row, whose next direction it stores. */
SHARED vec3 step_along(GLOBAL float4 *row, item_index at, real beta, vec3 change)
{
  vec3 step = scale(xyz(load_float4(row, at)), beta);
  store_float4(row, at, extend(add(step, change), R(0.0)));
  return step;
}

/* Continues along the direction: linear and angular impulses, which are stored, and returns their steps. */
SHARED joint_impulses advance_blocks(GLOBAL const Parameters *parameters, real beta, write_joint_impulses impulses,
                                     GLOBAL float4 *nncg_joint, item_index i)
{
  joint_impulses now = load_joint_impulses(parameters, impulses.linear, impulses.angular, i),
                 change = between_impulses(load_before(parameters, nncg_joint, i), now), step = change;
  step.linear = step_along(nncg_joint, nncg_row(parameters, NNCG_DIRECTION + NNCG_LINEAR, i), beta, change.linear);
  vec4 linear = extend(add(now.linear, step.linear), R(0.0));
  store_float4(impulses.linear, i, linear);
  store_float4(nncg_joint, nncg_row(parameters, NNCG_LINEAR, i), linear);
  if (!HAS_FEATURE(parameters, JOINT_FRAMES)) return step;
  step.angular = step_along(nncg_joint, nncg_row(parameters, NNCG_DIRECTION + NNCG_ANGULAR, i), beta, change.angular);
  vec4 angular = extend(add(now.angular, step.angular), R(0.0));
  store_float4(impulses.angular, i, angular);
  store_float4(nncg_joint, nncg_row(parameters, NNCG_ANGULAR, i), angular);
  return step;
}

/* The same of the axes; adds what they give to the wrench. */
SHARED joint_wrench advance_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f, real beta,
                                 read_joint_axes axes, GLOBAL float4 *impulse, GLOBAL float4 *nncg_joint_axis,
                                 joint_wrench w, item_index i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    item_index at = joint_plane(parameters, k) + i;
    vec4 before = load_float4(nncg_joint_axis, at), now = load_float4(impulse, at);
    vec3 step = step_along(nncg_joint_axis, nncg_axis_row(parameters, k, i), beta, subtract(xyz(now), xyz(before)));
    vec4 next = extend(add(xyz(now), step), now.w);
    store_float4(impulse, at, next);
    store_float4(nncg_joint_axis, at, next);
    w = with_wrench_of_axis(j, f, load_uint(axes.kind, at), (step.x + step.y) + step.z, w);
  }
  return w;
}

SHARED void nncg_advance_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                     read_turning_bodies bodies, read_joint_axes axes,
                                     GLOBAL const memory_real *nncg_state, write_joint_impulses impulses,
                                     GLOBAL float4 *nncg_joint, GLOBAL float4 *nncg_joint_axis,
                                     GLOBAL float4 *solver_velocity, item_index i)
{
  real beta = nncg_state[NNCG_BETA];
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_wrench w = joint_wrench_of(parameters, j, f, advance_blocks(parameters, beta, impulses, nncg_joint, i));
  if (HAS_FEATURE(parameters, JOINT_AXES))
    w = advance_axes(parameters, j, f, beta, axes, impulses.axis, nncg_joint_axis, w, i);
  push_side(&j.a, w.impulse, w.moment_a, R(-1.0));
  push_side(&j.b, w.impulse, w.moment_b, R(1.0));
  store_joint_velocities(solver_velocity, j);
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
#include "shared/joints/overflow.h"

SHARED void nncg_advance_overflow_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                              read_turning_bodies bodies, read_joint_axes axes,
                                              GLOBAL const memory_real *nncg_state, GLOBAL const uint *counts,
                                              write_joint_impulses impulses, GLOBAL float4 *nncg_joint,
                                              GLOBAL float4 *nncg_joint_axis, GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_JOINT(i)
  nncg_advance_joints_item(parameters, joints, bodies, axes, nncg_state, impulses, nncg_joint, nncg_joint_axis,
                           solver_velocity, i);
}
#endif

#endif
