/* command_codes.h - the kinds of commands, for kernels and the host, and what the three rows of command_value hold for
 * each.
 *
 *   kind                first row        second row           third row
 *   SET_POSE            position         low part of it       orientation
 *   SET_VELOCITY        linear, m/s      angular, rad/s
 *   ADD_IMPULSE         impulse, N s     angular, N m s
 *   ADD_IMPULSE_AT      impulse, N s     point                low part of it
 *   MOVE_TO             position         low part of it       orientation
 *   ADD_FORCE           force, N         torque, N m
 *   ADD_FORCE_AT        force, N         point                low part of it
 *   SET_MASS            inverse mass, gravity factor, 1 if the body keeps its velocity
 */
#ifndef TANDEM_SHARED_COMMANDS_COMMAND_CODES_H
#define TANDEM_SHARED_COMMANDS_COMMAND_CODES_H

enum {
  COMMAND_SET_POSE = 0,
  COMMAND_SET_VELOCITY = 1,
  COMMAND_ADD_IMPULSE = 2,
  COMMAND_ADD_IMPULSE_AT = 3,
  COMMAND_MOVE_TO = 4,
  COMMAND_ADD_FORCE = 5,
  COMMAND_ADD_FORCE_AT = 6,
  COMMAND_SET_MASS = 7
};

#endif
