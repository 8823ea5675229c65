/* scene.h - what a user describes: shapes, materials, bodies, gravity.
 *
 * The first station of the pipeline. Loaders (scene files) and generators (built-in scenes)
 * produce a Scene; specialise and World consume it. Nothing here computes physics; units are
 * SI (metre, kilogram, second, radian), coordinates right-handed.
 */
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tandem {

/* Bad use or bad input: one line that says what is wrong, where, and what would be right.
 * The command prints it and exits with status 2. */
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Vec3 = std::array<float, 3>;
using Quat = std::array<float, 4>; /* x y z w, unit length */

enum class ShapeType : uint32_t { sphere = 0, box = 1, half_space = 2 };

/* sphere: size[0] = radius. box: half extents. half_space: all points with y <= 0 in the body's
 * frame (its outward normal is the body's +Y axis); size is ignored; never dynamic. */
struct Shape {
  ShapeType type = ShapeType::box;
  Vec3 size{0.5f, 0.5f, 0.5f};
};

inline Shape sphere_shape(float radius) { return {ShapeType::sphere, {radius, radius, radius}}; }
inline Shape box_shape(float x, float y, float z) { return {ShapeType::box, {x, y, z}}; } /* half extents */
inline Shape half_space_shape() { return {ShapeType::half_space, {0, 0, 0}}; }

/* How the values of two materials become one. Of two different rules the first in this order
 * wins, except that geometric_mean (our default) yields to any other. After
 * KHR_physics_rigid_bodies. */
enum class Combine : uint32_t { average = 0, minimum = 1, maximum = 2, multiply = 3, geometric_mean = 4 };

struct Material {
  std::string name;
  float static_friction = 0.6f;  /* >= 0 */
  float dynamic_friction = 0.6f; /* >= 0 */
  float restitution = 0.0f;      /* 0 .. 1 */
  Combine friction_combine = Combine::geometric_mean; /* of all four kinds of friction */
  Combine restitution_combine = Combine::maximum;
  float rolling_friction = 0.0f;  /* m, >= 0: the torque against rolling is at most this times the normal force */
  float spinning_friction = 0.0f; /* m, >= 0: the same about the normal */
};

enum class Motion : uint32_t {
  fixed = 0,     /* never moves */
  kinematic = 1, /* moves with its given velocities, infinitely heavy */
  dynamic = 2
};

struct Body {
  std::string name;
  Motion motion = Motion::dynamic;
  uint32_t shape = 0;    /* index into Scene::shapes */
  uint32_t material = 0; /* index into Scene::materials */
  Vec3 position{0, 0, 0}; /* centre of mass, which is the shape's centre */
  Quat orientation{0, 0, 0, 1};
  Vec3 linear_velocity{0, 0, 0};  /* world axes */
  Vec3 angular_velocity{0, 0, 0}; /* world axes */
  float mass = 1.0f;              /* > 0 for dynamic bodies; ignored otherwise */
  Vec3 inertia{0, 0, 0};          /* principal moments about body axes; all 0: from shape and mass */
  bool infinite_inertia = false;  /* never rotates under torque */
  float gravity_factor = 1.0f;
  float linear_damping = 0.0f;  /* 1/s, >= 0 */
  float angular_damping = 0.0f; /* 1/s, >= 0 */
  uint32_t filter_group = 1;           /* bit set of the groups this body is in */
  uint32_t filter_mask = 0xffffffffu;  /* groups it collides with; both bodies must agree */
};

struct Scene {
  std::string name;
  Vec3 gravity{0, -10, 0};
  std::vector<Shape> shapes;
  std::vector<Material> materials{Material{}}; /* at least one */
  std::vector<Body> bodies;
};

/* Throws InputError naming the first body, shape or material that cannot be simulated:
 * non-finite or non-positive sizes and masses, NaN or infinite poses, zero quaternions,
 * indices out of range, dynamic half-spaces. `where` prefixes the message (a file name). */
void validate(const Scene &scene, const std::string &where);

/* Principal moments of inertia of a solid shape of uniform density about its centre. */
Vec3 inertia_of(const Shape &shape, float mass);

} // namespace tandem
