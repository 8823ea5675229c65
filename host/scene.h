/* scene.h - what a user describes: shapes, materials, bodies, gravity.
 *
 * The first station of the pipeline. Loaders (scene files) and generators (built-in scenes)
 * produce a Scene; specialise and World consume it. Nothing here computes physics; units are
 * SI (metre, kilogram, second, radian), coordinates right-handed.
 */
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/round_to_float.h"

namespace tandem {

/* Bad use or bad input: one line that says what is wrong, where, and what would be right.
 * The command prints it and exits with status 2. */
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Vec3 = std::array<float, 3>;
using Point = std::array<double, 3>; /* of the world, m: a float is 6 cm apart from the next 1,000 km away */
using Quat = std::array<float, 4>;  /* x y z w, unit length */

inline Vec3 rounded(const Point &p) { return {round_to_float(p[0]), round_to_float(p[1]), round_to_float(p[2])}; }

enum class ShapeType : uint32_t { sphere = 0, box = 1, half_space = 2, capsule = 3, cylinder = 4, hull = 5, mesh = 6, compound = 8 };

struct ConvexHull;   /* host/geometry/convex_hull.h */
struct TriangleMesh; /* host/geometry/triangle_mesh.h */
struct Compound;

/* In the shape's own frame:
 *   sphere      size[0]: radius
 *   box         size: half extents
 *   half_space  all points with y <= 0 (its outward normal is +Y); size is ignored; never dynamic, without a pose of its own
 *   capsule     hull of two spheres on the Y axis. size: radius of the lower, half the distance of the centres, radius of the upper
 *   cylinder    along Y, between -size[1] and +size[1]; size[0]: radius of the lower end, size[2]: of the upper. One may be 0: a cone
 *   hull        `hull`; size is ignored
 *   mesh        the surface `mesh`, solid on the side from which its triangles are seen clockwise: contacts push out on the other. Size
 *               is ignored. A dynamic one should be closed (warnings_of): else its mass is that of a solid that it is not
 *   compound    `compound`; size is ignored */
struct Shape {
  ShapeType type = ShapeType::box;
  Vec3 size{0.5f, 0.5f, 0.5f};
  std::shared_ptr<const ConvexHull> hull = nullptr; /* these are shared by the copies of a shape */
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  std::shared_ptr<const Compound> compound = nullptr;
};

/* A shape in a compound; not a half-space, nor another compound. What it leaves open is as its body says. */
struct Child {
  Shape shape;
  Vec3 position{0, 0, 0};       /* in the compound's frame */
  Quat orientation{0, 0, 0, 1};
  float density = 1.0f;         /* > 0, relative to the other children */
  std::optional<uint32_t> material;     /* index into Scene::materials */
  std::optional<uint32_t> filter_group, filter_mask;
};

struct Compound {
  std::vector<Child> children;
};

inline Shape sphere_shape(float radius) { return {ShapeType::sphere, {radius, radius, radius}}; }
inline Shape box_shape(float x, float y, float z) { return {ShapeType::box, {x, y, z}}; } /* half extents */
inline Shape capsule_shape(float radius, float half_height) { return {ShapeType::capsule, {radius, half_height, radius}}; }
inline Shape cylinder_shape(float radius, float half_height) { return {ShapeType::cylinder, {radius, half_height, radius}}; }
inline Shape cone_shape(float radius, float half_height) { return {ShapeType::cylinder, {radius, half_height, 0}}; } /* apex up */
/* InputError as convex_hull of host/geometry/convex_hull.h. */
Shape hull_shape(std::span<const Vec3> points, const std::string &where);
/* InputError as triangle_mesh of host/geometry/triangle_mesh.h. Indices: three a triangle, counter-clockwise seen from outside. */
Shape mesh_shape(std::span<const Vec3> vertices, std::span<const uint32_t> indices, const std::string &where);
/* A mesh of heights over a grid: heights[z * columns + x] at (x * spacing_x, height, z * spacing_z), centred on the origin across.
 * columns and rows: at least 2 each. InputError otherwise, and for heights that are not finite. */
Shape height_field_shape(std::span<const float> heights, uint32_t columns, float spacing_x, float spacing_z, const std::string &where);
Shape compound_shape(std::vector<Child> children);
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
  bool trigger = false;  /* is touched and reported (World::contact_events), but neither pushes nor is pushed */
  uint32_t shape = 0;    /* index into Scene::shapes */
  uint32_t material = 0; /* index into Scene::materials */
  Point position{0, 0, 0};      /* centre of mass */
  Quat orientation{0, 0, 0, 1}; /* of the principal axes of inertia */
  Vec3 shape_position{0, 0, 0}; /* of the shape's frame in the body's: not 0 where the shape's origin is not the centre of mass */
  Quat shape_orientation{0, 0, 0, 1};
  Vec3 linear_velocity{0, 0, 0};  /* world axes */
  Vec3 angular_velocity{0, 0, 0}; /* world axes */
  float mass = 1.0f;              /* > 0 for dynamic bodies; ignored otherwise */
  Vec3 inertia{0, 0, 0};          /* principal moments about body axes; one or two 0: infinite there; all 0: from shape and mass */
  bool infinite_inertia = false;  /* never rotates under torque */
  float gravity_factor = 1.0f;
  float linear_damping = 0.0f;  /* 1/s, >= 0 */
  float angular_damping = 0.0f; /* 1/s, >= 0 */
  uint32_t filter_group = 1;           /* bit set of the groups this body is in */
  uint32_t filter_mask = 0xffffffffu;  /* groups it collides with; both bodies must agree */
  bool continuous = false; /* collides along its way through a step, so that thin walls hold at any speed; not for half-spaces */
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

/* One line for each body that can be simulated, but hardly as meant: moving meshes that are not closed, whose volume is a guess. */
std::vector<std::string> warnings_of(const Scene &scene, const std::string &where);

/* Principal moments of inertia of a solid shape of uniform density about its centre of mass, in the order of the axes that
 * take_mass_properties gives its body. */
Vec3 inertia_of(const Shape &shape, float mass);

/* For a body whose position, orientation and shape pose place its shape: makes the shape's centre of mass and principal axes (of
 * uniform density) the body's own, and leaves the shape where it is in the world. Nothing to do for shapes that are symmetric. */
void take_mass_properties(const Scene &scene, Body &body);

} // namespace tandem
