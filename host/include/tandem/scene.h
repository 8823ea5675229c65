/* scene.h - what a user describes: shapes, materials, bodies, joints, couplings and actuators of these, gravity.
 *
 * It is the first stage of the pipeline: loaders (scene files) and generators (built-in scenes) produce a Scene,
 * specialise and World consume it. Nothing here computes physics. Units are SI (metre, kilogram, second, radian),
 * coordinates right-handed.
 */
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <tandem/actuators.h>
#include <tandem/articulation.h>
#include <tandem/axes.h>
#include <tandem/couplings.h>
#include <tandem/error.h>
#include <tandem/export.h>
#include <tandem/joints.h>
#include <tandem/shapes.h>

namespace tandem {

/* How the values of two materials are combined. If the two rules differ, the first in this order wins, except that
 * geometric_mean (the default) yields to any other. The rules follow KHR_physics_rigid_bodies. */
enum class Combine : uint32_t { average = 0, minimum = 1, maximum = 2, multiply = 3, geometric_mean = 4 };

struct Material {
  std::string name;
  float static_friction = 0.6f;                       /* >= 0 */
  float dynamic_friction = 0.6f;                      /* >= 0 */
  float restitution = 0.0f;                           /* 0 .. 1 */
  Combine friction_combine = Combine::geometric_mean; /* of all four kinds of friction */
  Combine restitution_combine = Combine::maximum;
  float rolling_friction = 0.0f;  /* m, >= 0: the torque against rolling is at most this times the normal force */
  float spinning_friction = 0.0f; /* m, >= 0: the same about the normal */
};

enum class BodyType : uint32_t {
  fixed = 0,     /* never moves */
  kinematic = 1, /* moves with its given velocities, as if infinitely heavy */
  dynamic = 2
};

struct Body {
  std::string name;
  BodyType type = BodyType::dynamic;
  bool trigger = false;         /* contacts are reported (World::contact_events), but exert no forces */
  uint32_t shape = 0;           /* index into Scene::shapes */
  uint32_t material = 0;        /* index into Scene::materials */
  Point position{0, 0, 0};      /* centre of mass */
  Quat orientation{0, 0, 0, 1}; /* of the principal axes of inertia */
  Vec3 shape_position{
      0, 0, 0}; /* of the shape's frame in the body's; not 0 if the shape's origin is not the centre of mass */
  Quat shape_orientation{0, 0, 0, 1};
  Vec3 linear_velocity{0, 0, 0};  /* world axes */
  Vec3 angular_velocity{0, 0, 0}; /* world axes */
  float mass = 1.0f;              /* > 0 for dynamic bodies; ignored otherwise */
  Vec3 inertia{0, 0,
               0}; /* principal moments about body axes; one or two 0: infinite there; all 0: from shape and mass */
  bool infinite_inertia = false; /* never rotates under torque */
  float gravity_factor = 1.0f;
  float linear_damping = 0.0f;        /* 1/s, >= 0 */
  float angular_damping = 0.0f;       /* 1/s, >= 0 */
  uint32_t filter_group = 1;          /* bit set of the groups this body is in */
  uint32_t filter_mask = 0xffffffffu; /* groups it collides with; both bodies must accept each other */
  bool continuous =
      false; /* continuous collision detection: thin walls stop the body at any speed; not for half-spaces */
  /* Axes along which, and about which, a dynamic body does not move, whatever pushes it: its mass or moment is infinite
   * there, and a velocity that it is given there becomes 0 in the next step. The solver avbd has no locks. */
  Axes linear_locks, angular_locks;
  /* > 0; a substep does not begin with a dynamic body faster than this, but its contacts may push it further. */
  float max_linear_speed = std::numeric_limits<float>::infinity();  /* m/s */
  float max_angular_speed = std::numeric_limits<float>::infinity(); /* rad/s */
  uint64_t user_data = 0;                                           /* whatever the program likes; nothing reads it */
};

struct Scene {
  std::string name;
  Vec3 gravity{0, -10, 0};
  std::vector<Shape> shapes;
  std::vector<Material> materials{Material{}}; /* at least one */
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Coupling> couplings; /* of joints */
  /* Trees that the step has in reduced coordinates (articulations.h); the other joints hold bodies. */
  std::vector<Articulation> articulations;
  std::vector<Actuator> actuators; /* of axes of joints; they do nothing until a program sets their controls */
  std::vector<std::string> notes;  /* of the loader, a line each: what of its file the scene has in another way */
};

/* Throws InputError that names the first body, shape, material or joint that cannot be simulated: non-finite or
 * non-positive sizes and masses, NaN or infinite poses, quaternions that are not of unit length, indices out of range,
 * dynamic half-spaces. `where` prefixes the message (a file name). */
TANDEM_API void validate(const Scene &scene, const std::string &where);

/* The same of one more body, shape, material or joint of a scene; index: the number that the message names. */
TANDEM_API void validate(const Scene &scene, const Body &body, size_t index, const std::string &where);
TANDEM_API void validate(const Shape &shape, size_t index, const std::string &where);
TANDEM_API void validate(const Material &material, size_t index, const std::string &where);

TANDEM_API void validate(const Scene &scene, const Joint &joint, size_t index, const std::string &where);
TANDEM_API void validate(const Scene &scene, const Coupling &coupling, size_t index, const std::string &where);
TANDEM_API void validate(const Scene &scene, const Actuator &actuator, size_t index, const std::string &where);

/* One line for each body that can be simulated, but probably not as intended: a moving mesh that is not closed has only
 * an estimated volume. Scene::notes come first. */
TANDEM_API std::vector<std::string> warnings_of(const Scene &scene, const std::string &where);

/* Principal moments of inertia, in kg m^2, of a solid shape of uniform density about its centre of mass, in the order
 * of the axes that take_mass_properties gives its body. */
TANDEM_API Vec3 inertia_of(const Shape &shape, float mass);

/* Makes the shape's centre of mass and principal axes (of uniform density) the body's frame, and leaves the shape where
 * the body's position, orientation and shape pose have placed it in the world. A symmetric shape needs no change. */
TANDEM_API void take_mass_properties(const Scene &scene, Body &body);

} // namespace tandem
