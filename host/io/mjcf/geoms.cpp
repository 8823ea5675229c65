/* geoms.cpp - reads <geom> and <mesh>; see geoms.h. */
#include "host/io/mjcf/geoms.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "host/geometry/shape_mass.h"

namespace tandem {
namespace {

constexpr const char *geom_attributes[] = {MJCF_FRAME, "name",    "class",       "type",    "size",
                                           "fromto",   "mesh",    "mass",        "density", "friction",
                                           "condim",   "contype", "conaffinity", "solref"};

/* e to the power of -x for x >= 0, with the same bits everywhere, unlike that of the C library. */
double decayed(double x)
{
  double part = std::min(x, 700.0) / 1024, term = 1, sum = 1;
  for (int k = 1; k <= 12; ++k) sum += term *= -part / k;
  for (int k = 0; k < 10; ++k) sum *= sum;
  return sum;
}

/* A contact of MuJoCo is a spring with a damper. Of the speed at which two bodies meet it returns
 * exp(-pi z / sqrt(1 - z^2)) at a damping ratio z below 1, and nothing above. */
double restitution_of(const std::vector<double> &solref)
{
  if (solref.size() < 2) return 0;
  double ratio = solref[1];
  if (solref[0] <= 0) ratio = solref[0] < 0 ? -solref[1] / (2 * std::sqrt(-solref[0])) : 1;
  if (!(ratio >= 0) || ratio >= 1) return 0;
  return decayed(std::numbers::pi * ratio / std::sqrt(1 - ratio * ratio));
}

/* A set of 32 bits, which a file may also write as a negative number. */
uint32_t bits_of_attribute(const XmlElement &geom, const char *key)
{
  const double value = geom.number_or(key, 1);
  if (value != std::floor(value) || value < -2147483648.0 || value > 4294967295.0)
    geom.fail(fmt::format("{} is {:g}; a whole number of 32 bits is needed", key, value));
  return uint32_t(int64_t(value));
}

/* The sizes of a geom, and its pose, where `fromto` gives both ends of it. */
struct GeomSize {
  std::vector<double> size;
  RigidFrame pose;
  std::optional<double> half_length;
};

GeomSize size_of(const XmlElement &geom, const MjcfCompiler &compiler)
{
  GeomSize result{geom.numbers("size", 1, 3), compiler.frame_of(geom), {}};
  const std::vector<double> ends = geom.numbers("fromto", 6, 6);
  if (ends.empty()) return result;
  const Vector from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]), along = to - from;
  result.half_length = along.norm() / 2;
  const Vector z = checked_axis(geom, "fromto", array_of(along));
  const Vector x = any_across(z);
  result.pose = {0.5 * (from + to), rotation_of_axes(x, z.cross(x))};
  return result;
}

float length_at(const XmlElement &geom, const GeomSize &size, size_t index, bool along = false)
{
  if (along && size.half_length) return checked_length(geom, "half the length of fromto", *size.half_length);
  if (size.size.size() <= index)
    geom.fail(fmt::format("size has {} numbers; {} are needed for this type", size.size.size(), index + 1));
  return checked_length(geom, "a size", size.size[index]);
}

/* The points of a grid of 16 meridians and 9 parallels. */
Shape ellipsoid_hull(const Vec3 &radii, const std::string &where)
{
  std::vector<Vec3> points{{0, 0, radii[2]}, {0, 0, -radii[2]}};
  for (int parallel = 1; parallel < 10; ++parallel)
    for (int meridian = 0; meridian < 16; ++meridian) {
      const SineCosine down = sine_cosine(std::numbers::pi * parallel / 10),
                       round = sine_cosine(std::numbers::pi * meridian / 8);
      points.push_back({round_to_float(double{radii[0]} * down.sine * round.cosine),
                        round_to_float(double{radii[1]} * down.sine * round.sine),
                        round_to_float(double{radii[2]} * down.cosine)});
    }
  return hull_shape(points, where);
}

MassProperties ellipsoid_mass(const Vec3 &radii)
{
  const double a = double{radii[0]}, b = double{radii[1]}, c = double{radii[2]};
  const double mass = 4 * std::numbers::pi / 3 * a * b * c, fifth = mass / 5;
  return {mass, {}, {fifth * (b * b + c * c), fifth * (a * a + c * c), fifth * (a * a + b * b), 0, 0, 0}};
}

} // namespace

void MjcfGeoms::read_assets(const XmlElement &asset)
{
  constexpr const char *known[] = {"mesh"};
  notes_.add_other_children(asset, known);
  for (const XmlElement *mesh : asset.children_named("mesh")) {
    const std::string file = mesh->text("file").value_or("");
    const size_t start = file.rfind('/') + 1; /* 0 if there is none */
    const std::string stem = file.substr(start, file.rfind('.') - start);
    const std::string name = mesh->text("name").value_or(stem);
    if (name.empty()) mesh->fail("name or file is missing; one is needed");
    if (!meshes_.emplace(name, defaults_.completed(*mesh, "")).second)
      mesh->fail(fmt::format("mesh \"{}\" stands twice; names are needed once", name));
  }
}

Shape MjcfGeoms::read_mesh(const XmlElement &mesh) const
{
  constexpr const char *known[] = {"name", "class", "file", "scale", "vertex"};
  notes_.add_other_attributes(mesh, known);
  const Double3 scale = mesh.vector_or("scale", {1, 1, 1});
  const Vec3 factors{round_to_float(scale[0]), round_to_float(scale[1]), round_to_float(scale[2])};
  if (const auto file = mesh.text("file")) {
    const std::string folder = compiler_.meshdir.empty() || compiler_.meshdir.ends_with('/') ? "" : "/";
    return hull_of_file(mesh, compiler_.meshdir + folder + *file, factors, outside_);
  }
  const std::vector<double> numbers = mesh.numbers("vertex", 12, 3'000'000);
  if (numbers.empty()) mesh.fail("file or vertex is missing; one is needed");
  if (numbers.size() % 3 != 0)
    mesh.fail(fmt::format("vertex has {} numbers; three a vertex are needed", numbers.size()));
  std::vector<Vec3> points(numbers.size() / 3);
  for (size_t k = 0; k < numbers.size(); ++k) points[k / 3][k % 3] = round_to_float(numbers[k]);
  return hull_shape(scaled(points, factors, mesh.place()), mesh.place());
}

const Shape &MjcfGeoms::mesh_shape_of(const XmlElement &geom)
{
  const std::string name = geom.needed_text("mesh");
  const auto mesh = meshes_.find(name);
  if (mesh == meshes_.end()) geom.fail(fmt::format("mesh \"{}\" does not exist in this file", name));
  const auto known = hulls_.find(name);
  return known != hulls_.end() ? known->second : hulls_.emplace(name, read_mesh(mesh->second)).first->second;
}

/* False if there is no such shape. Capsules, cylinders and planes have Z in the file where they have Y here. */
bool MjcfGeoms::set_shape(const XmlElement &geom, MjcfGeom &result, MassProperties &solid)
{
  const std::string type = geom.text("type").value_or("sphere");
  const GeomSize size = size_of(geom, compiler_);
  const auto at = [&](size_t index, bool along = false) { return length_at(geom, size, index, along); };
  Shape &shape = result.shape.shape;
  result.shape.pose = size.pose;
  if (type == "sphere") shape = sphere_shape(at(0));
  else if (type == "capsule") shape = capsule_shape(at(0), at(1, true));
  else if (type == "cylinder") shape = cylinder_shape(at(0), at(1, true));
  else if (type == "box")
    shape = size.half_length ? box_shape(at(0), at(0), at(2, true)) : box_shape(at(0), at(1), at(2));
  else if (type == "mesh") shape = mesh_shape_of(geom);
  else if (type == "plane") shape = half_space_shape();
  else if (type == "ellipsoid") {
    const Vec3 radii = size.half_length ? Vec3{at(0), at(0), at(2, true)} : Vec3{at(0), at(1), at(2)};
    shape = ellipsoid_hull(radii, geom.place());
    solid = ellipsoid_mass(radii);
    notes_.add(geom, "an ellipsoid collides as a hull of 146 points");
    return true;
  } else {
    if (type != "hfield" && type != "sdf")
      geom.fail(
          fmt::format("type is \"{}\"; plane, sphere, capsule, ellipsoid, cylinder, box and mesh are read", type));
    notes_.add(geom, fmt::format("a geom of type {} is left out", type));
    return false;
  }
  if (type == "capsule" || type == "cylinder" || type == "plane") result.shape.pose = size.pose * y_along_z();
  if (type != "plane") solid = mass_properties_of(shape);
  return true;
}

/* Friction of two geoms is the larger one, as in MuJoCo; without friction (condim 1) it is that of the other. */
uint32_t MjcfGeoms::material_of(const XmlElement &geom)
{
  std::vector<double> friction = geom.numbers("friction", 1, 3);
  const double usual[] = {1, 0.005, 0.0001}, dimensions = geom.number_or("condim", 3);
  while (friction.size() < 3) friction.push_back(usual[friction.size()]);
  for (double x : friction)
    if (!(x >= 0)) geom.fail(fmt::format("friction is {:g}; at least 0 is needed", x));
  if (dimensions != 1 && dimensions != 3 && dimensions != 4 && dimensions != 6)
    geom.fail(fmt::format("condim is {:g}; 1, 3, 4 or 6 is needed", dimensions));
  Material material;
  material.static_friction = material.dynamic_friction = dimensions < 3 ? 0 : round_to_float(friction[0]);
  material.spinning_friction = dimensions < 4 ? 0 : round_to_float(friction[1]);
  material.rolling_friction = dimensions < 6 ? 0 : round_to_float(friction[2]);
  material.restitution = round_to_float(restitution_of(geom.numbers("solref", 1, 2)));
  material.friction_combine = Combine::maximum;
  material.restitution_combine = Combine::average;
  const auto [at, is_new] = materials_.emplace(
      std::array{material.static_friction, material.spinning_friction, material.rolling_friction, material.restitution},
      uint32_t(scene_.materials.size()));
  if (is_new) scene_.materials.push_back(material);
  return at->second;
}

std::optional<MjcfGeom> MjcfGeoms::read(const XmlElement &geom, const RigidFrame &outer)
{
  notes_.add_other_attributes(geom, geom_attributes);
  MjcfGeom result;
  MassProperties solid;
  result.shape.name = geom.text("name").value_or("");
  if (!set_shape(geom, result, solid)) return {};
  result.shape.pose = outer * result.shape.pose;
  result.shape.material = material_of(geom);
  result.contype = bits_of_attribute(geom, "contype");
  result.conaffinity = bits_of_attribute(geom, "conaffinity");
  const double mass = geom.at_least_zero_or("mass", geom.at_least_zero_or("density", 1000) * solid.mass);
  if (mass > 0 && solid.mass > 0) result.mass = placed_mass(with_mass(solid, mass), result.shape.pose);
  return result;
}

} // namespace tandem
