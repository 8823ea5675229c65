/* catalog.cpp - the rows of the catalogue, and the parser of `name:key=value,…`; see catalog.h. */
#include "host/catalog/catalog.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include <tandem/round_to_float.h>

#include "host/base/random.h"
#include "host/catalog/builders.h"
#include "host/catalog/closed_forms.h"
#include "host/catalog/joints.h"
#include "host/catalog/machines.h"
#include "host/catalog/mechanisms.h"
#include "host/catalog/meshes.h"
#include "host/catalog/shapes.h"
#include "host/catalog/structures.h"
#include "host/catalog/talks.h"
#include "host/catalog/vehicle.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* The smallest side with side * side * layers >= count. */
int64_t square_side(int64_t count, int64_t layers)
{
  int64_t side = 1;
  while (side * side * layers < count) ++side;
  return side;
}

/* --- box-grid: the scene of the published comparisons; layers are shifted against each other ---- */

uint64_t box_grid_bodies(const SceneValues &v)
{
  return 1 + uint64_t(whole(v, "nx") * whole(v, "ny") * whole(v, "nz"));
}

Scene box_grid(const SceneValues &v)
{
  int64_t nx = whole(v, "nx"), ny = whole(v, "ny"), nz = whole(v, "nz");
  Scene scene;
  scene.shapes = {box_shape(400, 400, 400), box_shape(1, 1, 1)};
  Body &ground = add_body(scene, 0, {0, -400, 0});
  ground.name = "ground";
  ground.type = BodyType::fixed;
  for (int64_t i = 0; i < nx; ++i)
    for (int64_t j = 0; j < ny; ++j)
      for (int64_t k = 0; k < nz; ++k) {
        double shift = double((j + 1) & 1);
        double x = shift + double(i - nx / 2) * 2.2, y = double(1 + 2 * j), z = shift + double(k - nz / 2) * 2.2;
        add_body(scene, 1, {round_to_float(x), round_to_float(y), round_to_float(z)});
      }
  return scene;
}

/* --- falling-boxes -------------------------------------------------------------------------- */

Scene falling_boxes(const SceneValues &v)
{
  int64_t n = whole(v, "n");
  double half = number(v, "half_extent"), radius = half * std::sqrt(3.0), jitter = 0.25 * half;
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.shapes = {box_shape(round_to_float(half), round_to_float(half), round_to_float(half))};
  add_ground(scene);
  /* The stack is twice as high as wide, so that the boxes fall on each other and pile up. */
  int64_t side = 1;
  while (2 * side * side * side < n) ++side;
  CellGrid grid{side, 2 * (radius + jitter) * 1.001, number(v, "height") + radius + jitter};
  for (int64_t i = 0; i < n; ++i) {
    Body &body = add_body(scene, 0, grid.place(i, jitter, random));
    body.orientation = random.orientation();
  }
  return scene;
}

/* --- box-stack: columns that must stand ------------------------------------------------------ */

Scene box_stack(const SceneValues &v)
{
  int64_t n = whole(v, "n"), height = whole(v, "height");
  double half = number(v, "half_extent"), pitch = 2 * half + number(v, "gap");
  int64_t side = square_side(n, height);
  Scene scene;
  scene.shapes = {box_shape(round_to_float(half), round_to_float(half), round_to_float(half))};
  add_ground(scene);
  for (int64_t i = 0; i < n; ++i) {
    int64_t column = i / height, level = i % height;
    double x = (double(column % side) - 0.5 * double(side - 1)) * pitch;
    double z = (double(column / side) - 0.5 * double(side - 1)) * pitch;
    add_body(scene, 0, {round_to_float(x), round_to_float(half * double(1 + 2 * level)), round_to_float(z)},
             round_to_float(number(v, "mass")));
  }
  return scene;
}

/* --- pyramid: each box rests on two --------------------------------------------------------- */

uint64_t pyramid_bodies(const SceneValues &v) { return 1 + uint64_t(whole(v, "rows") * (whole(v, "rows") + 1) / 2); }

Scene pyramid(const SceneValues &v)
{
  int64_t rows = whole(v, "rows");
  double half = number(v, "half_extent"), pitch = 2 * half + number(v, "gap");
  Scene scene;
  scene.shapes = {box_shape(round_to_float(half), round_to_float(half), round_to_float(half))};
  add_ground(scene);
  for (int64_t row = 0; row < rows; ++row)
    for (int64_t i = 0; i < rows - row; ++i) {
      double x = (double(i) - 0.5 * double(rows - row - 1)) * pitch;
      add_body(scene, 0, {round_to_float(x), round_to_float(half * double(1 + 2 * row)), 0});
    }
  return scene;
}

/* --- spheres -------------------------------------------------------------------------------- */

Scene spheres(const SceneValues &v)
{
  int64_t n = whole(v, "n");
  double radius = number(v, "radius"), jitter = number(v, "jitter") * radius;
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.materials[0].restitution = round_to_float(number(v, "restitution"));
  scene.shapes = {sphere_shape(round_to_float(radius))};
  add_ground(scene);
  const int64_t side = cube_side(n);
  CellGrid grid{side, 2 * (radius + jitter) * 1.001, number(v, "height") + radius + jitter};
  for (int64_t i = 0; i < n; ++i) add_body(scene, 0, grid.place(i, jitter, random));
  return scene;
}

/* --- mixed: all shapes, several sizes and materials, in a walled yard ------------------------- */

std::vector<Material> mixed_materials()
{
  auto material = [](const char *name, float static_friction, float dynamic_friction, float restitution) {
    Material m;
    m.name = name;
    m.static_friction = static_friction;
    m.dynamic_friction = dynamic_friction;
    m.restitution = restitution;
    return m;
  };
  std::vector<Material> materials{material("stone", 0.7f, 0.6f, 0.0f), material("wood", 0.5f, 0.4f, 0.2f),
                                  material("rubber", 1.0f, 0.9f, 0.7f), material("ice", 0.05f, 0.02f, 0.1f)};
  materials[2].restitution_combine = Combine::average;
  materials[3].friction_combine = Combine::minimum;
  return materials;
}

double volume(const Shape &shape)
{
  double x = shape.size[0], y = shape.size[1], z = shape.size[2];
  return shape.type == ShapeType::sphere ? 4.0 / 3.0 * 3.14159265358979 * x * x * x : 8 * x * y * z;
}

uint64_t mixed_bodies(const SceneValues &v) { return 5 + uint64_t(whole(v, "n")); }

Scene mixed(const SceneValues &v)
{
  int64_t n = whole(v, "n");
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.materials = mixed_materials();
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f),
                  box_shape(0.8f, 0.2f, 0.4f),
                  box_shape(0.25f, 0.7f, 0.25f),
                  box_shape(0.15f, 0.15f, 0.15f),
                  sphere_shape(0.5f),
                  sphere_shape(0.3f),
                  sphere_shape(0.15f)};
  const auto movable = uint32_t(scene.shapes.size());
  const double largest_radius = 0.92, jitter = 0.1; /* half the diagonal of the plank */
  const int64_t side = cube_side(n);
  CellGrid grid{side, 2 * (largest_radius + jitter), largest_radius + jitter};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(side) + 0.5);
  for (int64_t i = 0; i < n; ++i) {
    uint32_t shape = random.below(movable), material = random.below(uint32_t(scene.materials.size()));
    double density = random.uniform(200, 2000);
    Body &body =
        add_body(scene, shape, grid.place(i, jitter, random), round_to_float(density * volume(scene.shapes[shape])));
    body.material = material;
    body.orientation = random.orientation();
  }
  return scene;
}

/* --- the rows -------------------------------------------------------------------------------- */

const SceneParameter seed = seed_parameter(), half_extent = half_extent_parameter();
const double most = double(most_bodies - 5);

std::vector<BuiltInScene> simple_scenes()
{
  /* 360 columns are the most that the ground of half extent 400 holds. */
  return {
      {"box-grid",
       "nx * ny * nz boxes of half extent 1 in shifted layers on a static box; the scene of the published comparisons",
       {{"nx", integer, 20, 1, 360, "boxes along x"},
        {"ny", integer, 20, 1, 10000, "layers"},
        {"nz", integer, 20, 1, 360, "boxes along z"}},
       box_grid_bodies,
       box_grid},
      {"falling-boxes",
       "cubes in random poses above a ground; they fall and pile up",
       {{"n", integer, 3000, 1, most, "boxes"},
        half_extent,
        {"height", real, 1, 0, 10000, "free height under the lowest box, m"},
        seed},
       ground_and_n,
       falling_boxes},
      {"box-stack",
       "columns of touching cubes that must stand",
       {{"n", integer, 1000, 1, most, "boxes"},
        {"height", integer, 10, 1, 10000, "boxes in a column"},
        half_extent,
        {"gap", real, 0.5, 0, 1000, "free width between columns, m"},
        {"mass", real, 1, 1e-6, 1e9, "mass of a box, kg"}},
       ground_and_n,
       box_stack},
      {"pyramid",
       "a wall of cubes, each resting on two",
       {{"rows", integer, 20, 1, 2800, "rows; the lowest has as many cubes"},
        half_extent,
        {"gap", real, 0.05, 0, 1000, "free width between the cubes of a row, m"}},
       pyramid_bodies,
       pyramid},
      {"spheres",
       "equal spheres dropped from a jittered grid",
       {{"n", integer, 1000, 1, most, "spheres"},
        {"radius", real, 0.5, 0.001, 1000, "m"},
        {"restitution", real, 0, 0, 1, "of spheres and ground"},
        {"jitter", real, 0.1, 0, 10, "largest random shift per axis, in radii"},
        {"height", real, 1, 0, 10000, "free height under the lowest sphere, m"},
        seed},
       ground_and_n,
       spheres},
      {"mixed",
       "boxes and spheres of seven sizes and four materials in a walled yard",
       {{"n", integer, 500, 1, most, "moving bodies"}, seed},
       mixed_bodies,
       mixed},
  };
}

const std::vector<BuiltInScene> &catalog()
{
  static const std::vector<BuiltInScene> rows = [] {
    std::vector<BuiltInScene> all = simple_scenes();
    for (BuiltInScene &scene : shape_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : mesh_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : structure_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : talk_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : closed_form_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : joint_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : machine_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : mechanism_scenes()) all.push_back(std::move(scene));
    all.push_back(vehicle_scene());
    return all;
  }();
  return rows;
}

/* --- the parser ------------------------------------------------------------------------------ */

std::string scene_names()
{
  std::string names;
  for (const BuiltInScene &scene : catalog()) names += (names.empty() ? "" : ", ") + std::string(scene.name);
  return names;
}

std::string parameter_names(const BuiltInScene &scene)
{
  std::string names;
  for (const SceneParameter &p : scene.parameters) names += (names.empty() ? "" : ", ") + std::string(p.name);
  return names;
}

const BuiltInScene &find_scene(const std::string &name)
{
  for (const BuiltInScene &scene : catalog())
    if (name == scene.name) return scene;
  throw InputError(
      fmt::format("unknown scene '{}'; built-in scenes: {}; scene files end in .json, .gltf, .glb, .urdf or .xml", name,
                  scene_names()));
}

const SceneParameter &find_parameter(const BuiltInScene &scene, const std::string &name)
{
  for (const SceneParameter &p : scene.parameters)
    if (name == p.name) return p;
  throw InputError(
      fmt::format("scene {}: unknown parameter '{}'; parameters: {}", scene.name, name, parameter_names(scene)));
}

double parse_value(const BuiltInScene &scene, const SceneParameter &parameter, const std::string &text)
{
  bool is_integer = parameter.type == integer;
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool malformed =
      error == std::errc::invalid_argument || end != text.data() + text.size() || text.empty() || std::isnan(value);
  if (malformed || (is_integer && std::isfinite(value) && value != std::floor(value)))
    throw InputError(fmt::format("scene {}: {}={}: {} is needed", scene.name, parameter.name, text,
                                 is_integer ? "an integer" : "a number"));
  if (error != std::errc() || value < parameter.minimum || value > parameter.maximum)
    throw InputError(fmt::format("scene {}: {}={} is out of range; {} to {} is possible", scene.name, parameter.name,
                                 text, parameter.minimum, parameter.maximum));
  return value;
}

void parse_assignment(SceneSpec &spec, const std::string &text)
{
  size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("scene {}: '{}' is not key=value; parameters: {}", spec.scene->name, text,
                                 parameter_names(*spec.scene)));
  const SceneParameter &parameter = find_parameter(*spec.scene, text.substr(0, equals));
  double value = parse_value(*spec.scene, parameter, text.substr(equals + 1));
  if (!spec.values.emplace(parameter.name, value).second)
    throw InputError(fmt::format("scene {}: parameter '{}' is given twice", spec.scene->name, parameter.name));
}

std::string describe(const SceneSpec &spec)
{
  std::string text = spec.scene->name;
  char separator = ':';
  for (const SceneParameter &p : spec.scene->parameters) {
    text += fmt::format("{}{}={}", separator, p.name, spec.values.find(p.name)->second);
    separator = ',';
  }
  return text;
}

/* Without a limit where the system does not say. */
uint64_t memory_of_machine()
{
  const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && bytes > 0 ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(bytes) : UINT64_MAX;
}

} // namespace

std::span<const BuiltInScene> built_in_scenes() { return catalog(); }

SceneSpec parse_scene_spec(const std::string &text)
{
  size_t colon = text.find(':');
  SceneSpec spec{&find_scene(text.substr(0, colon)), {}};
  for (size_t start = colon; start != std::string::npos;) {
    size_t comma = text.find(',', start + 1);
    size_t length = comma == std::string::npos ? std::string::npos : comma - start - 1;
    parse_assignment(spec, text.substr(start + 1, length));
    start = comma;
  }
  for (const SceneParameter &p : spec.scene->parameters) spec.values.emplace(p.name, p.default_value);
  check_bodies(text, spec.scene->body_count(spec.values), memory_of_machine());
  return spec;
}

void check_bodies(const std::string &scene, uint64_t bodies, uint64_t memory)
{
  if (bodies > most_bodies)
    throw InputError(fmt::format("scene {}: {} bodies; at most {} are possible", scene, bodies, most_bodies));
  constexpr uint64_t copies = 2;
  if (const uint64_t needed = copies * sizeof(Body) * bodies; needed > memory)
    throw InputError(fmt::format("scene {}: {} bodies take {} bytes, and this machine has {}; at most {} are possible",
                                 scene, bodies, needed, memory, memory / (copies * sizeof(Body))));
}

Scene build_scene(const SceneSpec &spec)
{
  Scene scene = spec.scene->build(spec.values);
  scene.name = describe(spec);
  validate(scene, scene.name);
  return scene;
}

} // namespace tandem
