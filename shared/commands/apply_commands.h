/* apply_commands.h - applies what a program asked of bodies between two steps, in the order of its calls.
 *
 * The host collects the calls and sorts them by body; calls to one body keep their order (host/world/commands.h):
 *
 *   command_start     0       3   4       one entry for each body that has commands, and the end
 *   command           2 2 2   5   9 9     body and kind
 *
 * An item is a body with commands. Different bodies are therefore processed in parallel, and the result does not depend
 * on the order of items. The kernels run once before a step and write the state in place: a step that runs again with
 * larger buffers starts from the state after them.
 */
#ifndef TANDEM_SHARED_COMMANDS_APPLY_COMMANDS_H
#define TANDEM_SHARED_COMMANDS_APPLY_COMMANDS_H

#include "shared/argument_groups.h"
#include "shared/commands/command_codes.h"
#include "shared/records.h"
#include "shared/trigonometry.h"

SHARED vec3 command_row(GLOBAL const float4 *command_value, uint command, uint row)
{
  return xyz(load_float4(command_value, command * 3u + row));
}
SHARED double_float3 command_position(GLOBAL const float4 *command_value, uint command, uint row)
{
  double_float3 p = {command_row(command_value, command, row), command_row(command_value, command, row + 1u)};
  return p;
}

SHARED vec3 difference_of_positions(double_float3 to, double_float3 from)
{
  return add(subtract(to.high, from.high), subtract(to.low, from.low));
}

SHARED quat conjugate_of(quat q) { return make_quat(R(0.0) - q.x, R(0.0) - q.y, R(0.0) - q.z, q.w); }

/* The rotation from one orientation to another as a vector: axis times angle, the shorter way round. */
#define SMALL_SINE R(1e-6)
SHARED vec3 rotation_between(quat from, quat to)
{
  quat d = quat_multiply(to, conjugate_of(from));
  real sign = d.w < R(0.0) ? R(-1.0) : R(1.0);
  vec3 axis = scale(make_vec3(d.x, d.y, d.z), sign);
  real sine = length_of(axis);
  /* For a small angle the angle over its sine is 2 to rounding. */
  real factor = sine > SMALL_SINE ? R(2.0) * arc_tangent(sine, sign * d.w) / sine : R(2.0);
  return scale(axis, factor);
}

SHARED void set_pose(GLOBAL const float4 *command_value, uint command, GLOBAL float4 *body_position,
                     GLOBAL float4 *body_orientation, uint body)
{
  store_position(body_position, body, command_position(command_value, command, 0u));
  store_float4(body_orientation, body, load_float4(command_value, command * 3u + 2u));
}

/* The velocity row keeps its fourth numbers: the inverse mass and the gravity factor. */
SHARED void store_linear_and_angular(GLOBAL float4 *body_velocity, uint body, vec3 linear, vec3 angular)
{
  store_float4(body_velocity, body * 2u, extend(linear, load_float4(body_velocity, body * 2u).w));
  store_float4(body_velocity, body * 2u + 1u, extend(angular, load_float4(body_velocity, body * 2u + 1u).w));
}

/* Sets the fourth numbers, which follow from the properties of the body. */
SHARED void set_mass(GLOBAL float4 *body_velocity, uint body, vec3 values)
{
  spatial_velocity m = load_velocity(body_velocity, body);
  vec3 zero = make_vec3(R(0.0), R(0.0), R(0.0));
  mask keeps = values.z > R(0.0);
  store_float4(body_velocity, body * 2u, extend(choose3(keeps, m.linear, zero), values.x));
  store_float4(body_velocity, body * 2u + 1u, extend(choose3(keeps, m.angular, zero), values.y));
}

/* The velocity with which the body reaches a pose at the end of the step. */
SHARED void move_to(GLOBAL const Parameters *parameters, GLOBAL const float4 *command_value, uint command,
                    GLOBAL const float4 *body_position, GLOBAL const float4 *body_orientation,
                    GLOBAL float4 *body_velocity, uint body)
{
  vec3 way = difference_of_positions(command_position(command_value, command, 0u), load_position(body_position, body));
  vec3 turn = rotation_between(quat_from(load_float4(body_orientation, body)),
                               quat_from(load_float4(command_value, command * 3u + 2u)));
  real rate = R(1.0) / parameters->step;
  store_linear_and_angular(body_velocity, body, scale(way, rate), scale(turn, rate));
}

/* locks: of the body, 0 without locks. */
SHARED void add_impulse(GLOBAL const float4 *body_mass, uint locks, GLOBAL const float4 *body_orientation,
                        GLOBAL float4 *body_velocity, uint body, vec3 impulse, vec3 angular_impulse)
{
  spatial_velocity m = load_velocity(body_velocity, body);
  symmetric3 inverse_inertia =
      rotate_diagonal(rotation_of(quat_from(load_float4(body_orientation, body))), xyz(load_float4(body_mass, body)));
  if (locks != 0u) {
    impulse = without_locked_axes(impulse, linear_locks(locks));
    inverse_inertia = held_about_axes(inverse_inertia, angular_locks(locks));
  }
  store_linear_and_angular(body_velocity, body, add_scaled(m.linear, impulse, m.inverse_mass),
                           add(m.angular, symmetric_times(inverse_inertia, angular_impulse)));
}

/* The moment, about the body's centre, of a force or an impulse at the point in the second and third row. */
SHARED vec3 moment_of_command(GLOBAL const float4 *command_value, uint command, GLOBAL const float4 *body_position,
                              uint body)
{
  vec3 arm = difference_of_positions(command_position(command_value, command, 1u), load_position(body_position, body));
  return cross3(arm, command_row(command_value, command, 0u));
}

/* A fixed body has no velocity, whatever is asked. */
SHARED void apply_commands_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                GLOBAL const float4 *body_mass, GLOBAL const uint *body_lock, read_commands commands,
                                GLOBAL float4 *body_position, GLOBAL float4 *body_orientation,
                                GLOBAL float4 *body_velocity, uint i)
{
  for (uint k = commands.start[i]; k < commands.start[i + 1u]; ++k) {
    uint body = commands.command[2u * k], kind = commands.command[2u * k + 1u];
    uint locks = HAS_FEATURE(parameters, LOCKS) ? body_lock[body] : 0u;
    int stands = body_type_of(body_flags[body]) == (uint)BODY_TYPE_FIXED;
    vec3 first = command_row(commands.value, k, 0u), second = command_row(commands.value, k, 1u);
    if (kind == (uint)COMMAND_SET_POSE) set_pose(commands.value, k, body_position, body_orientation, body);
    else if (kind == (uint)COMMAND_SET_MASS) set_mass(body_velocity, body, first);
    else if (stands) continue;
    else if (kind == (uint)COMMAND_SET_VELOCITY) store_linear_and_angular(body_velocity, body, first, second);
    else if (kind == (uint)COMMAND_MOVE_TO)
      move_to(parameters, commands.value, k, body_position, body_orientation, body_velocity, body);
    else if (kind == (uint)COMMAND_ADD_IMPULSE)
      add_impulse(body_mass, locks, body_orientation, body_velocity, body, first, second);
    else if (kind == (uint)COMMAND_ADD_IMPULSE_AT)
      add_impulse(body_mass, locks, body_orientation, body_velocity, body, first,
                  moment_of_command(commands.value, k, body_position, body));
  }
}

/* Forces act from the state at the start of the step, so they are added when all other commands have been applied. */
SHARED void add_forces_item(read_commands commands, GLOBAL const float4 *body_position, GLOBAL float4 *body_force,
                            uint i)
{
  for (uint k = commands.start[i]; k < commands.start[i + 1u]; ++k) {
    uint body = commands.command[2u * k], kind = commands.command[2u * k + 1u];
    vec3 torque = kind == (uint)COMMAND_ADD_FORCE_AT ? moment_of_command(commands.value, k, body_position, body)
                                                     : command_row(commands.value, k, 1u);
    vec3 force = add(xyz(load_float4(body_force, body * 2u)), command_row(commands.value, k, 0u));
    store_float4(body_force, body * 2u, extend(force, R(0.0)));
    store_float4(body_force, body * 2u + 1u, extend(add(xyz(load_float4(body_force, body * 2u + 1u)), torque), R(0.0)));
  }
}

#endif
