/* scene.cpp - what makes a scene impossible to simulate, said before the simulation starts.
 *
 * Every loader and generator ends here, so that the later stages can rely on finite numbers, unit
 * quaternions and indices in range, and never check them again.
 */
#include "host/scene.h"

#include <cmath>
#include <fmt/format.h>

namespace tandem {
namespace {

[[noreturn]] void refuse(const std::string &where, const std::string &what, const std::string &why)
{
  throw InputError(fmt::format("{}: {}: {}", where, what, why));
}

bool finite(const Vec3 &v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

std::string text(const Vec3 &v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string label(const char *kind, size_t index, const std::string &name)
{
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} '{}'", kind, index, name);
}

/* One named check about one thing: `where: what: why` is put together only when it fails. */
struct Checker {
  const std::string &where;
  const char *kind;
  size_t index;
  const std::string &name;

  [[noreturn]] void fail(const std::string &why) const { refuse(where, label(kind, index, name), why); }

  void finite_vector(const char *field, const Vec3 &v) const
  {
    if (!finite(v)) fail(fmt::format("{} is {}; three finite numbers are needed", field, text(v)));
  }
  void at_least_zero(const char *field, float x) const
  {
    if (!(x >= 0) || !std::isfinite(x))
      fail(fmt::format("{} is {}; a finite number of at least 0 is needed", field, x));
  }
  void positive(const char *field, float x) const
  {
    if (!(x > 0) || !std::isfinite(x)) fail(fmt::format("{} is {}; a finite number above 0 is needed", field, x));
    /* The solver works with 1/x: it must not overflow. */
    if (!std::isfinite(1.0f / x)) fail(fmt::format("{} is {}, too small: its inverse is not a finite float", field, x));
  }
};

void check_shape(const Shape &shape, const Checker &check)
{
  check.finite_vector("size", shape.size);
  switch (shape.type) {
  case ShapeType::sphere: check.positive("radius", shape.size[0]); return;
  case ShapeType::box:
    for (int axis = 0; axis < 3; ++axis) check.positive("a half extent", shape.size[axis]);
    return;
  case ShapeType::half_space: return;
  }
  check.fail("unknown shape type; sphere, box and half_space exist");
}

void check_material(const Material &material, const Checker &check)
{
  check.at_least_zero("static_friction", material.static_friction);
  check.at_least_zero("dynamic_friction", material.dynamic_friction);
  check.at_least_zero("rolling_friction", material.rolling_friction);
  check.at_least_zero("spinning_friction", material.spinning_friction);
  if (!(material.restitution >= 0 && material.restitution <= 1))
    check.fail(fmt::format("restitution is {}; a number from 0 to 1 is needed", material.restitution));
  if (material.friction_combine > Combine::geometric_mean || material.restitution_combine > Combine::geometric_mean)
    check.fail("unknown combine rule; average, minimum, maximum, multiply and geometric_mean exist");
}

void check_pose(const Body &body, const Checker &check)
{
  check.finite_vector("position", body.position);
  const Quat &q = body.orientation;
  double length_squared = 0;
  for (float x : q) length_squared += double(x) * x;
  if (!(std::abs(length_squared - 1.0) < 2e-3)) /* also true for NaN */
    check.fail(
        fmt::format("orientation is [{}, {}, {}, {}]; a quaternion of length 1 is needed", q[0], q[1], q[2], q[3]));
  check.finite_vector("linear_velocity", body.linear_velocity);
  check.finite_vector("angular_velocity", body.angular_velocity);
}

void check_inertia(const Body &body, const Shape &shape, const Checker &check)
{
  if (body.infinite_inertia) return;
  bool from_shape = body.inertia == Vec3{0, 0, 0};
  Vec3 moments = from_shape ? inertia_of(shape, body.mass) : body.inertia;
  for (float moment : moments) check.positive(from_shape ? "inertia from shape and mass" : "inertia", moment);
}

void check_body(const Body &body, const Scene &scene, const Checker &check)
{
  if (body.motion > Motion::dynamic) check.fail("unknown motion; fixed, kinematic and dynamic exist");
  if (body.shape >= scene.shapes.size())
    check.fail(fmt::format("shape {} does not exist; the scene has {}", body.shape, scene.shapes.size()));
  if (body.material >= scene.materials.size())
    check.fail(fmt::format("material {} does not exist; the scene has {}", body.material, scene.materials.size()));
  check_pose(body, check);
  if (!std::isfinite(body.gravity_factor))
    check.fail(fmt::format("gravity_factor is {}; a finite number is needed", body.gravity_factor));
  check.at_least_zero("linear_damping", body.linear_damping);
  check.at_least_zero("angular_damping", body.angular_damping);
  if (!std::isfinite(body.mass)) check.fail(fmt::format("mass is {}; a finite number is needed", body.mass));
  check.finite_vector("inertia", body.inertia);
  if (body.motion != Motion::dynamic) return;
  const Shape &shape = scene.shapes[body.shape];
  if (shape.type == ShapeType::half_space) check.fail("a half_space cannot be dynamic; make it fixed or kinematic");
  check.positive("mass", body.mass);
  check_inertia(body, shape, check);
}

} // namespace

void validate(const Scene &scene, const std::string &where)
{
  if (!finite(scene.gravity))
    refuse(where, "gravity", "is " + text(scene.gravity) + "; three finite numbers are needed");
  if (scene.materials.empty()) refuse(where, "materials", "there are none; a scene needs at least one");
  const std::string unnamed;
  for (size_t i = 0; i < scene.shapes.size(); ++i) check_shape(scene.shapes[i], {where, "shape", i, unnamed});
  for (size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene.materials[i], {where, "material", i, scene.materials[i].name});
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    check_body(scene.bodies[i], scene, {where, "body", i, scene.bodies[i].name});
}

Vec3 inertia_of(const Shape &shape, float mass)
{
  if (shape.type == ShapeType::half_space) return {0, 0, 0};
  double m = mass, x = shape.size[0], y = shape.size[1], z = shape.size[2];
  if (shape.type == ShapeType::sphere) {
    float moment = float(0.4 * m * x * x);
    return {moment, moment, moment};
  }
  return {float(m / 3 * (y * y + z * z)), float(m / 3 * (x * x + z * z)), float(m / 3 * (x * x + y * y))};
}

} // namespace tandem
