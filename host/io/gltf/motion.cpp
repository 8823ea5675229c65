/* motion.cpp - reads masses, centres of mass, inertia and velocities; see motion.h. */
#include "host/io/gltf/motion.h"

#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/shape_mass.h"

namespace tandem {
namespace {

constexpr double default_density = 1000; /* kg/m³, for motions without a mass */

bool is_plane(const Scene &scene, const Body &body) { return scene.shapes[body.shape].type == ShapeType::half_space; }

bool read_flag(const JsonValue &motion, const char *key)
{
  std::optional<JsonValue> flag = motion.find(key);
  return flag && flag->boolean();
}

/* Converts a vector from node space to world axes: it is rotated, but not scaled. In a mirrored node a velocity is
 * mirrored too; a spin is a pseudovector and changes its sign in addition. */
Vec3 turned_to_world(const Transform &world, const Vec3 &local, bool spin)
{
  double turned[3] = {0, 0, 0};
  const double sign = spin && is_mirrored(world) ? -1 : 1;
  for (size_t j = 0; j < 3; ++j) {
    const double *column = world.column[j],
                 length = std::sqrt(column[0] * column[0] + column[1] * column[1] + column[2] * column[2]);
    for (size_t row = 0; row < 3; ++row) turned[row] += sign * column[row] / length * double(local[j]);
  }
  return {round_to_float(turned[0]), round_to_float(turned[1]), round_to_float(turned[2])};
}

void read_velocities(const JsonValue &motion, const Transform &world, Body &body)
{
  if (const auto linear = motion.find("linearVelocity"))
    body.linear_velocity = turned_to_world(world, linear->vec3(), false);
  if (const auto angular = motion.find("angularVelocity"))
    body.angular_velocity = turned_to_world(world, angular->vec3(), true);
}

/* The rotation from the axes of inertia to those of the body's frame. In a mirrored node that frame is the node's with
 * X reversed, so the axes, which are lines, are mirrored along X. */
std::optional<Rotation> read_axes(const JsonValue &motion, const Transform &world)
{
  std::optional<JsonValue> json = motion.find("inertiaOrientation");
  if (!json) return {};
  const Quat q = json->quat();
  const double length =
      std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
  if (!(std::abs(length - 1) < 1e-2)) json->fail("is not a quaternion of length 1");
  const bool turned = std::abs(q[0]) + std::abs(q[1]) + std::abs(q[2]) > 1e-6f;
  if (turned && !motion.find("inertiaDiagonal")) json->fail("turns an inertiaDiagonal, which is missing");
  const double mirror = is_mirrored(world) ? -1 : 1;
  return Rotation{q[0] / length, mirror * q[1] / length, mirror * q[2] / length, q[3] / length};
}

/* A zero stands for infinity, about one axis or all. */
void read_inertia(const JsonValue &motion, Body &body)
{
  std::optional<JsonValue> diagonal = motion.find("inertiaDiagonal");
  if (!diagonal) return;
  body.inertia = diagonal->magnitudes();
  body.infinite_inertia = body.inertia == Vec3{0, 0, 0};
}

/* A position in node space, to which the node's scale applies as to every other position there. */
std::optional<Double3> read_center(const JsonValue &motion, const Transform &world, bool plane)
{
  std::optional<JsonValue> json = motion.find("centerOfMass");
  if (!json) return {};
  const Vec3 center = json->vec3();
  if (plane && center != Vec3{0, 0, 0}) json->fail("a centre of mass of a plane is not supported yet");
  return transformed(world, {center[0], center[1], center[2]});
}

/* Throws if the shape has no volume from which the value could be computed. */
template <class Calculate> void require_volume(const JsonValue &motion, const Calculate &calculate)
{
  try {
    calculate();
  } catch (const InputError &error) {
    motion.fail(fmt::format("without mass, inertiaDiagonal and centerOfMass, all three, these are the shape's: {}",
                            error.what()));
  }
}

/* Moves the frame to the given centre and axes; one that is missing is that of the shape. */
void move_to_mass(const Scene &scene, const std::optional<Double3> &center, const std::optional<Rotation> &axes,
                  Body &body)
{
  if (is_plane(scene, body)) return;
  if (center && axes) return move_frame(body, *center, *axes);
  Body uniform = body;
  take_mass_properties(scene, uniform);
  if (!center && !axes) {
    body = uniform;
    return;
  }
  const Quat &q = uniform.orientation;
  move_frame(body, center.value_or(uniform.position), axes.value_or(Rotation{q[0], q[1], q[2], q[3]}));
}

/* A mass of zero stands for infinity. */
bool is_infinite(const JsonValue &motion, const Body &body)
{
  std::optional<JsonValue> mass = motion.find("mass");
  if (!mass || mass->number() != 0) return false;
  if (body.inertia != Vec3{0, 0, 0}) mass->fail("an infinite mass with a finite inertia is not supported yet");
  return true;
}

} // namespace

void read_gltf_motion(const JsonValue &motion, const Transform &world, GltfMover mover, const Scene &scene, Body &body)
{
  static constexpr const char *keys[] = {
      "isKinematic",     "mass",          "centerOfMass", "inertiaDiagonal", "inertiaOrientation", "linearVelocity",
      "angularVelocity", "gravityFactor", "extras",       "extensions"};
  motion.only_keys(keys);
  const Quat node = body.orientation;
  if (auto factor = motion.find("gravityFactor")) body.gravity_factor = factor->number();
  if (mover == GltfMover::physics) read_velocities(motion, world, body);
  const std::optional<Double3> center = read_center(motion, world, is_plane(scene, body));
  std::optional<Rotation> axes = read_axes(motion, world);
  const bool given = read_flag(motion, "isKinematic") || mover == GltfMover::file;
  if (!given) read_inertia(motion, body);
  const bool kinematic = given || is_infinite(motion, body);
  const bool own_moments = !kinematic && body.inertia != Vec3{0, 0, 0};
  if (own_moments) axes = product(Rotation{node[0], node[1], node[2], node[3]}, axes.value_or(Rotation{0, 0, 0, 1}));
  else axes.reset();
  if (!kinematic || has_volume(scene.shapes[body.shape]))
    require_volume(motion, [&] { move_to_mass(scene, center, axes, body); });
  else if (center) move_frame(body, *center, Rotation{node[0], node[1], node[2], node[3]});
  body.type = kinematic ? BodyType::kinematic : BodyType::dynamic;
  if (kinematic) {
    body.infinite_inertia = false;
    return;
  }
  if (is_plane(scene, body)) motion.fail("a plane that moves freely is not supported yet");
  std::optional<JsonValue> mass = motion.find("mass");
  if (mass) body.mass = mass->number();
  else
    require_volume(motion, [&] {
      body.mass = round_to_float(default_density * mass_properties_of(scene.shapes[body.shape]).mass);
    });
}

} // namespace tandem
