/* couplings.h - what couples a coordinate of one joint with a coordinate of another: gears, racks, pulleys.
 *
 * With q the coordinate of each joint, a coupling holds q_a + ratio q_b = offset:
 *
 *   gear              two angles; the ratio is teeth_b / teeth_a, and the equation holds but for whole teeth
 *   rack_and_pinion   an angle and a way; the ratio is -2 pi / travel, and the equation holds but for whole teeth_a
 *   pulley            two distances; a rope of the length `offset`, which only pulls
 *   mimic             any two
 *
 * docs/joints.md shows each. Impulses of a coupling act between the bodies of each joint, so they change no momentum of
 * what is free.
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <tandem/export.h>

namespace tandem {

enum class CouplingType : uint32_t { gear, rack_and_pinion, pulley, mimic };

/* The name of each type, in the order of the enum. */
TANDEM_API std::span<const char *const> coupling_type_names();

/* One that the joint leaves free, as JointAxis counts them. usual: the rotation about x of a gear and a pinion, the
 * direction x (or distance) of a rack and a pulley; of a mimic, the first of these two that is free. */
enum class JointCoordinate : uint32_t {
  usual,
  direction_x,
  direction_y,
  direction_z,
  rotation_x,
  rotation_y,
  rotation_z
};
TANDEM_API std::span<const char *const> joint_coordinate_names();

struct Coupling {
  std::string name;
  CouplingType type = CouplingType::gear;
  /* Indices into Scene::joints. The same joint twice couples two of its coordinates, as a screw does. */
  uint32_t joint_a = 0, joint_b = 0;
  JointCoordinate coordinate_a = JointCoordinate::usual, coordinate_b = JointCoordinate::usual;
  /* Of a gear, both; of a pinion, teeth_a. Wheels whose axes x point the same way mesh on the outside if both have the
   * same sign, and turn in opposite ways; a wheel in a ring, or joined by a chain, has the other sign. A load that
   * forces them by more than half a tooth makes them skip one. */
  int32_t teeth_a = 0, teeth_b = 0;
  float travel = 0;       /* of a rack, m for a turn of the pinion; below 0: it goes the other way */
  float ratio = 1;        /* of a pulley and a mimic */
  float offset = 0;       /* rad or m, as q_a */
  bool only_pulls = true; /* of a pulley: q_a + ratio q_b may also be less than the length */

  friend bool operator==(const Coupling &, const Coupling &) = default;
};

} // namespace tandem
