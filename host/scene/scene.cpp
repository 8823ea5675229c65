/* scene.cpp - validates scenes: it reports before the simulation starts what makes a scene impossible to simulate.
 *
 * Every loader and generator ends here, so that the later stages can rely on finite numbers, unit quaternions and
 * indices in range, and never check them again.
 */
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/base/finite_vector.h"
#include "host/geometry/shape_mass.h"
#include "host/geometry/triangle_mesh.h"
#include "host/scene/actuators.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/checker.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

/* The sides of a capsule, the common tangent of the two spheres, exist only if neither sphere contains the other. */
void check_capsule(const Shape &shape, const Checker &check)
{
  const float bottom = shape.size[0], half_height = shape.size[1], top = shape.size[2];
  check.length("radius_bottom", bottom);
  check.length("half_height", half_height);
  check.length("radius_top", top);
  if (std::abs(double(bottom) - top) >= 2.0 * half_height)
    check.fail(fmt::format(
        "one sphere of the capsule (radii {} and {}, {} apart) holds the other; a sphere of radius {} is the same",
        bottom, top, 2.0 * half_height, std::max(bottom, top)));
}

void check_cylinder(const Shape &shape, const Checker &check)
{
  check.at_least_zero("radius_bottom", shape.size[0]);
  check.length("half_height", shape.size[1]);
  check.at_least_zero("radius_top", shape.size[2]);
  check.length("the larger radius", std::max(shape.size[0], shape.size[2]));
}

void check_hull(const Shape &shape, const Checker &check)
{
  if (!shape.hull) check.fail("a hull without points; hull_shape makes one");
  if (shape.hull->vertices.size() < 4)
    check.fail(fmt::format("a hull of {} vertices; at least 4 are needed", shape.hull->vertices.size()));
  for (const Vec3 &vertex : shape.hull->vertices) check.within("a vertex of the hull", vertex, longest_length);
}

void check_shape(const Shape &shape, const Checker &check);

void check_child(const Child &child, const Checker &check)
{
  if (child.shape.type == ShapeType::half_space || child.shape.type == ShapeType::compound)
    check.fail("a half_space or compound cannot be a child; give a half_space a body of its own, and name a compound's "
               "children one by one");
  check_shape(child.shape, check);
  check.within("position", child.position, longest_length);
  check.unit("orientation", child.orientation);
  check.positive("density", child.density);
}

void check_compound(const Shape &shape, const Checker &check)
{
  if (!shape.compound || shape.compound->children.empty())
    check.fail("a compound without children; at least one is needed");
  for (size_t k = 0; k < shape.compound->children.size(); ++k) {
    const std::string kind = fmt::format("{} child", label(check.kind, check.index, check.name));
    check_child(shape.compound->children[k], {check.where, kind.c_str(), k, ""});
  }
}

void check_shape(const Shape &shape, const Checker &check)
{
  check.finite_vector("size", shape.size);
  switch (shape.type) {
  case ShapeType::sphere: check.length("radius", shape.size[0]); return;
  case ShapeType::box:
    for (int axis = 0; axis < 3; ++axis) check.length("a half extent", shape.size[axis]);
    return;
  case ShapeType::half_space: return;
  case ShapeType::capsule: check_capsule(shape, check); return;
  case ShapeType::cylinder: check_cylinder(shape, check); return;
  case ShapeType::hull: check_hull(shape, check); return;
  case ShapeType::mesh:
    if (!shape.mesh) check.fail("a mesh without triangles; mesh_shape makes one");
    for (const Vec3 &vertex : shape.mesh->vertices) check.within("a vertex of the mesh", vertex, longest_length);
    return;
  case ShapeType::compound: check_compound(shape, check); return;
  }
  check.fail("unknown shape type; sphere, box, half_space, capsule, cylinder, hull, mesh and compound exist");
}

void check_material(const Material &material, const Checker &check)
{
  check.friction("static_friction", material.static_friction);
  check.friction("dynamic_friction", material.dynamic_friction);
  check.friction("rolling_friction", material.rolling_friction);
  check.friction("spinning_friction", material.spinning_friction);
  if (!(material.restitution >= 0 && material.restitution <= 1))
    check.fail(fmt::format("restitution is {}; a number from 0 to 1 is needed", material.restitution));
  if (material.friction_combine > Combine::geometric_mean || material.restitution_combine > Combine::geometric_mean)
    check.fail("unknown combine rule; average, minimum, maximum, multiply and geometric_mean exist");
}

void check_pose(const Body &body, const Checker &check)
{
  check.within("position", body.position, farthest);
  check.unit("orientation", body.orientation);
  check.within("shape_position", body.shape_position, longest_length);
  check.unit("shape_orientation", body.shape_orientation);
  check.finite_vector("linear_velocity", body.linear_velocity);
  check.finite_vector("angular_velocity", body.angular_velocity);
}

Vec3 inertia_of_shape(const Body &body, const Shape &shape, const Checker &check)
{
  try {
    return inertia_of(shape, body.mass);
  } catch (const InputError &error) { /* the mesh has no volume */
    check.fail(error.what());
  }
}

void check_inertia(const Body &body, const Shape &shape, const Checker &check)
{
  if (body.infinite_inertia) return;
  bool from_shape = body.inertia == Vec3{0, 0, 0};
  Vec3 moments = from_shape ? inertia_of_shape(body, shape, check) : body.inertia;
  for (float moment : moments)
    if (from_shape || moment != 0) check.mass(from_shape ? "inertia from shape and mass" : "inertia", moment);
  const bool turned = body.shape_orientation != Quat{0, 0, 0, 1} || shape.type >= ShapeType::hull;
  if (from_shape && turned && !has_principal_axes(body, shape))
    check.fail("inertia from shape and mass is about the shape's principal axes, which are not the body's; give the "
               "inertia, or a density instead "
               "of the mass (take_mass_properties)");
}

void check_materials_of_children(const Shape &shape, const Scene &scene, const Checker &check)
{
  if (!shape.compound) return;
  for (size_t k = 0; k < shape.compound->children.size(); ++k)
    if (const auto material = shape.compound->children[k].material; material && *material >= scene.materials.size())
      check.fail(fmt::format("material {} of child {} does not exist; the scene has {}", *material, k,
                             scene.materials.size()));
}

void check_body(const Body &body, const Scene &scene, const Checker &check)
{
  if (body.type > BodyType::dynamic) check.fail("unknown motion; fixed, kinematic and dynamic exist");
  if (body.shape >= scene.shapes.size())
    check.fail(fmt::format("shape {} does not exist; the scene has {}", body.shape, scene.shapes.size()));
  if (body.material >= scene.materials.size())
    check.fail(fmt::format("material {} does not exist; the scene has {}", body.material, scene.materials.size()));
  check_materials_of_children(scene.shapes[body.shape], scene, check);
  check_pose(body, check);
  if (!std::isfinite(body.gravity_factor))
    check.fail(fmt::format("gravity_factor is {}; a finite number is needed", body.gravity_factor));
  check.at_least_zero("linear_damping", body.linear_damping);
  check.at_least_zero("angular_damping", body.angular_damping);
  check.speed("max_linear_speed", body.max_linear_speed);
  check.speed("max_angular_speed", body.max_angular_speed);
  if (!std::isfinite(body.mass)) check.fail(fmt::format("mass is {}; a finite number is needed", body.mass));
  check.finite_vector("inertia", body.inertia);
  const Shape &shape = scene.shapes[body.shape];
  if (shape.type == ShapeType::half_space &&
      (body.shape_position != Vec3{0, 0, 0} || body.shape_orientation != Quat{0, 0, 0, 1}))
    check.fail("a half_space has no pose in its body (shape_position, shape_orientation); move and turn the body");
  if (shape.type == ShapeType::half_space && body.continuous)
    check.fail("a half_space is not continuous: nothing comes out behind it; make the bodies that hit it so");
  if (body.type != BodyType::dynamic) return;
  if (shape.type == ShapeType::half_space) check.fail("a half_space cannot be dynamic; make it fixed or kinematic");
  check.mass("mass", body.mass);
  check_inertia(body, shape, check);
}

/* Welding vertices changes no surface, but triangles that are left out may have been intended. */
std::string left_out_of(const Shape &shape)
{
  if (shape.mesh)
    return shape.mesh->findings.degenerate_triangles + shape.mesh->findings.duplicate_triangles > 0
               ? cleaning_note(*shape.mesh)
               : "";
  for (size_t k = 0; shape.compound && k < shape.compound->children.size(); ++k)
    if (const std::string note = left_out_of(shape.compound->children[k].shape); !note.empty())
      return fmt::format("child {}: {}", k, note);
  return "";
}

std::string volume_doubt(const Shape &shape)
{
  if (shape.mesh) return volume_warning(*shape.mesh);
  for (size_t k = 0; shape.compound && k < shape.compound->children.size(); ++k)
    if (const std::string doubt = volume_doubt(shape.compound->children[k].shape); !doubt.empty())
      return fmt::format("child {}: {}", k, doubt);
  return "";
}

} // namespace

void validate(const Scene &scene, const Body &body, size_t index, const std::string &where)
{
  check_body(body, scene, {where, "body", index, body.name});
}

void validate(const Shape &shape, size_t index, const std::string &where)
{
  const std::string unnamed;
  check_shape(shape, {where, "shape", index, unnamed});
}

void validate(const Material &material, size_t index, const std::string &where)
{
  check_material(material, {where, "material", index, material.name});
}

void validate(const Scene &scene, const std::string &where)
{
  if (!is_finite_vector(scene.gravity))
    refuse(where, "gravity", "is " + vector_text(scene.gravity) + "; three finite numbers are needed");
  if (scene.materials.empty()) refuse(where, "materials", "there are none; a scene needs at least one");
  if (scene.materials.size() > MOST_MATERIALS)
    refuse(where, "materials", fmt::format("there are {}; at most {}", scene.materials.size(), MOST_MATERIALS));
  for (size_t i = 0; i < scene.shapes.size(); ++i) validate(scene.shapes[i], i, where);
  for (size_t i = 0; i < scene.materials.size(); ++i) validate(scene.materials[i], i, where);
  for (size_t i = 0; i < scene.bodies.size(); ++i) validate(scene, scene.bodies[i], i, where);
  for (size_t i = 0; i < scene.joints.size(); ++i) validate(scene, scene.joints[i], i, where);
  for (size_t i = 0; i < scene.couplings.size(); ++i) validate(scene, scene.couplings[i], i, where);
  check_actuators(scene, where);
  check_articulations(scene, where);
}

std::vector<std::string> warnings_of(const Scene &scene, const std::string &where)
{
  std::vector<std::string> warnings = scene.notes;
  for (size_t i = 0; i < scene.shapes.size(); ++i)
    if (const std::string note = left_out_of(scene.shapes[i]); !note.empty())
      warnings.push_back(fmt::format("{}: shape {}: {}", where, i, note));
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body &body = scene.bodies[i];
    const bool from_shape = body.type == BodyType::dynamic && body.inertia == Vec3{0, 0, 0} && !body.infinite_inertia;
    const std::string doubt = from_shape ? volume_doubt(scene.shapes[body.shape]) : "";
    if (!doubt.empty()) warnings.push_back(fmt::format("{}: {}: {}", where, label("body", i, body.name), doubt));
  }
  return warnings;
}

} // namespace tandem
