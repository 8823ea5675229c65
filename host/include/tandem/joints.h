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
  six_dof
};

/* The name of each type, in the order of the enum: "ball", "fixed" and so on. */
TANDEM_API std::span<const char *const> joint_type_names();

/* One direction (m, N, kg) or rotation (rad, N m, kg m^2) that a joint leaves free. */
struct JointAxis {
  static constexpr float unlimited = std::numeric_limits<float>::infinity();

  float lower = -unlimited, upper = unlimited;  /* limits; equal ones hold the axis there */
  float limit_stiffness = 0, limit_damping = 0; /* of soft limits; 0: hard ones */
  /* A spring pulls towards target_position and a damper towards target_velocity, with at most max_force in all; both
   * are stable at any stiffness. A motor has neither: it holds target_velocity as far as max_force suffices. */
  float target_position = 0, target_velocity = 0;
  float stiffness = 0, damping = 0; /* N/m and N s/m, or N m/rad and N m s/rad */
  bool motor = false;
  float max_force = unlimited; /* N, or N m */
  float friction = 0;          /* N, or N m: brakes with at most this */
  float max_speed = unlimited; /* m/s, or rad/s */

  friend bool operator==(const JointAxis &, const JointAxis &) = default;
};

struct Joint {
  std::string name;
  JointType type = JointType::ball;
  /* Indices into Scene::bodies, one of them of a dynamic body; no_body: the world, in which the frame of that side
   * stands. */
  uint32_t body_a = no_body, body_b = no_body;
  /* The frames: from the centre of mass, in the body's axes; of a side that is the world, in those of the world. */
  Point position_a{0, 0, 0}, position_b{0, 0, 0};
  Quat orientation_a{0, 0, 0, 1}, orientation_b{0, 0, 0, 1};
  bool collide = false;                 /* whether the two bodies collide */
  Axes held_directions, held_rotations; /* of a six_dof joint */
  /* Along and about the axes of frame a: translation, and rotation as a twist about x after which a swing takes x where
   * it is. A distance joint has its distance as directions[0], a cone_twist joint the angle of its cone as
   * rotations[1]; of a universal joint the turn about x of frame a is rotations[0], and that about y of frame b has no
   * axis here yet. Limits of rotations are both between -pi and pi; swings are right up to about 1.5 rad. */
  std::array<JointAxis, 3> directions, rotations;
};

} // namespace tandem
