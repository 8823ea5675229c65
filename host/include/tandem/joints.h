/* joints.h - what connects two bodies, or a body and the world.
 *
 * A joint has a frame on each side. It holds some directions and rotations of frame b in frame a, by its type, and may
 * limit, drive and brake those that it leaves free. docs/joints.md shows each type. The axis of a type that has one is
 * x.
 */
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include <tandem/axes.h>
#include <tandem/export.h>
#include <tandem/no_body.h>
#include <tandem/shapes.h>

namespace tandem {

/* six_dof: what it holds is Joint::held_directions and held_rotations. */
enum class JointType : uint32_t {
  ball,
  fixed,
  hinge,
  slider,
  cylindrical,
  plane,
  parallel,
  universal,
  cone_twist,
  distance,
  six_dof,
  wheel
};

/* The name of each type, in the order of the enum: "ball", "fixed" and so on. */
TANDEM_API std::span<const char *const> joint_type_names();

/* One direction (m, N, kg) or rotation (rad, N m, kg m^2) that a joint leaves free. */
struct JointAxis {
  static constexpr float unlimited = std::numeric_limits<float>::infinity();

  float lower = -unlimited, upper = unlimited;  /* limits; equal ones hold the axis there */
  float limit_stiffness = 0, limit_damping = 0; /* of soft limits; 0: hard ones */
  float restitution = 0; /* of hard limits: the share of the speed with which what arrives leaves; 0 to 1 */
  /* A spring pulls towards target_position and a damper towards target_velocity, with at most max_force in all,
   * `force` included; both are stable at any stiffness. A motor has neither: it holds target_velocity as far as
   * max_force suffices. */
  float target_position = 0, target_velocity = 0;
  float stiffness = 0, damping = 0; /* N/m and N s/m, or N m/rad and N m s/rad */
  bool motor = false;
  float force = 0;             /* N, or N m: pushes besides spring and damper, as an actuator does; a motor has none */
  float max_force = unlimited; /* N, or N m */
  float friction = 0;          /* N, or N m: brakes with at most this */
  float max_speed = unlimited; /* m/s, or rad/s */

  friend bool operator==(const JointAxis &, const JointAxis &) = default;
};

struct Joint {
  std::string name;
  JointType type = JointType::ball;
  bool enabled = true; /* a joint that is not does nothing, and its bodies collide; one that broke is not */
  /* Indices into Scene::bodies, one of them of a dynamic body; no_body: the world, in which the frame of that side
   * stands. */
  uint32_t body_a = no_body, body_b = no_body;
  /* The frames: from the centre of mass, in the body's axes; of a side that is the world, in those of the world. */
  Point position_a{0, 0, 0}, position_b{0, 0, 0};
  Quat orientation_a{0, 0, 0, 1}, orientation_b{0, 0, 0, 1};
  bool collide = false; /* whether the two bodies collide */
  /* It breaks where the force (N) or torque (N m) of its impulses is larger in a substep: see JointBreak. */
  float break_force = JointAxis::unlimited, break_torque = JointAxis::unlimited;
  Axes held_directions, held_rotations; /* of a six_dof joint */
  /* Along and about the axes of frame a: translation, and rotation as a twist about x after which a swing takes x where
   * it is. A distance joint has its distance as directions[0], a cone_twist joint the angle of its cone as
   * rotations[1]. Of a universal joint and a wheel, rotations[0] is the turn of y of frame b about x of frame a, and
   * rotations[1] the one about y of frame b; directions[0] is the suspension of a wheel. Limits of rotations are both
   * between -pi and pi; swings are right up to about 1.5 rad. */
  std::array<JointAxis, 3> directions, rotations;
};

/* A joint of a world: its place in Scene::joints, and a generation. The place of a joint that was destroyed is used
 * again by a later one, whose generation differs. The joints of the scene itself have generation 1. */
struct JointId {
  uint32_t index = 0xffffffffu;
  uint32_t generation = 0; /* 0: of no joint */
  friend bool operator==(const JointId &, const JointId &) = default;
};

/* A new row for one axis of a joint. */
struct JointAxisChange {
  uint32_t axis = 0; /* 0 to 2: directions x, y, z; 3 to 5: rotations */
  JointAxis to;
};

/* A joint that broke in the last step: it is not enabled any more. The force and the torque are the largest of the
 * step's substeps; one of them is larger than Joint::break_force or break_torque. */
struct JointBreak {
  JointId joint;
  float force = 0, torque = 0; /* N, N m */
};

/* What a joint does, as the last step left it. A joint that is not enabled reads 0; one that has never been in a step
 * has no force and no torque. */
struct JointReading {
  /* Of its impulses in the last substep, on body b at the origin of frame b, in axes of the world; body a gets the
   * opposite. The torque is about that origin. Held axes, limits, springs, motors and friction are in them. Those of a
   * joint of an articulation, which holds its bodies without impulses, follow from the momenta of the links
   * (docs/articulations.md), with Settings::tree_joint_forces; without it they are NaN. */
  std::array<double, 3> force{}, torque{}; /* N, N m */
  /* The coordinates in the order of Joint::directions and rotations, with or without a JointAxis, and how fast they
   * change; 0 for what a type has no axis for. */
  std::array<double, 3> directions{}, rotations{};             /* m, rad */
  std::array<double, 3> direction_speeds{}, rotation_speeds{}; /* m/s, rad/s */
};

} // namespace tandem
