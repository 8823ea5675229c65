/* scene_catalog.cpp - the rows of the catalogue, and the parser of `name:key=value,…`. */
#include "host/scene_catalog.h"

#include "host/random.h"
#include "host/scene_catalog_closed_forms.h"
#include "host/scene_catalog_structures.h"
#include "host/scene_gltf.h"
#include "host/scene_json.h"
#include "host/scene_talks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace tandem {
namespace {

constexpr auto integer = SceneParameter::Type::integer;
constexpr auto real = SceneParameter::Type::real;

int64_t whole(const SceneValues &values, const char *name) { return int64_t(values.find(name)->second); }
double number(const SceneValues &values, const char *name) { return values.find(name)->second; }

/* The smallest side with side * side * layers >= count. */
int64_t square_side(int64_t count, int64_t layers)
{
  int64_t side = 1;
  while (side * side * layers < count) ++side;
  return side;
}

/* Places `count` items in layers of side × side cells, centred over the origin, the lowest cell
 * centres at y = bottom: no two items whose radius plus jitter is below cell / 2 can touch. */
struct CellGrid {
  int64_t side;
  double cell, bottom;

  Vec3 place(int64_t index, double jitter, Random &random) const
  {
    int64_t layer = index / (side * side), within = index % (side * side);
    double x = (double(within % side) - 0.5 * double(side - 1)) * cell;
    double z = (double(within / side) - 0.5 * double(side - 1)) * cell;
    double dx = random.uniform(-jitter, jitter), dy = random.uniform(-jitter, jitter),
           dz = random.uniform(-jitter, jitter);
    return {float(x + dx), float(bottom + double(layer) * cell + dy), float(z + dz)};
  }
};

/* Body 0 of most scenes. */
void add_ground(Scene &scene, uint32_t material = 0)
{
  Body ground;
  ground.name = "ground";
  ground.motion = Motion::fixed;
  ground.shape = uint32_t(scene.shapes.size());
  ground.material = material;
  scene.shapes.push_back(half_space_shape());
  scene.bodies.push_back(ground);
}

Body dynamic_body(uint32_t shape, const Vec3 &position, float mass)
{
  Body body;
  body.shape = shape;
  body.position = position;
  body.mass = mass;
  return body;
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
  Body ground;
  ground.name = "ground";
  ground.motion = Motion::fixed;
  ground.position = {0, -400, 0};
  scene.bodies.push_back(ground);
  for (int64_t i = 0; i < nx; ++i)
    for (int64_t j = 0; j < ny; ++j)
      for (int64_t k = 0; k < nz; ++k) {
        double shift = double((j + 1) & 1);
        double x = shift + double(i - nx / 2) * 2.2, y = double(1 + 2 * j), z = shift + double(k - nz / 2) * 2.2;
        scene.bodies.push_back(dynamic_body(1, {float(x), float(y), float(z)}, 1));
      }
  return scene;
}

/* --- falling-boxes -------------------------------------------------------------------------- */

uint64_t ground_and_n(const SceneValues &v) { return 1 + uint64_t(whole(v, "n")); }

Scene falling_boxes(const SceneValues &v)
{
  int64_t n = whole(v, "n");
  double half = number(v, "half_extent"), radius = half * std::sqrt(3.0), jitter = 0.25 * half;
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.shapes = {box_shape(float(half), float(half), float(half))};
  add_ground(scene);
  /* Twice as high as wide, so that the boxes fall on each other and pile up. */
  int64_t side = 1;
  while (2 * side * side * side < n) ++side;
  CellGrid grid{side, 2 * (radius + jitter) * 1.001, number(v, "height") + radius + jitter};
  for (int64_t i = 0; i < n; ++i) {
    Body body = dynamic_body(0, grid.place(i, jitter, random), 1);
    body.orientation = random.orientation();
    scene.bodies.push_back(body);
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
  scene.shapes = {box_shape(float(half), float(half), float(half))};
  add_ground(scene);
  for (int64_t i = 0; i < n; ++i) {
    int64_t column = i / height, level = i % height;
    double x = (double(column % side) - 0.5 * double(side - 1)) * pitch;
    double z = (double(column / side) - 0.5 * double(side - 1)) * pitch;
    scene.bodies.push_back(
        dynamic_body(0, {float(x), float(half * double(1 + 2 * level)), float(z)}, float(number(v, "mass"))));
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
  scene.shapes = {box_shape(float(half), float(half), float(half))};
  add_ground(scene);
  for (int64_t row = 0; row < rows; ++row)
    for (int64_t i = 0; i < rows - row; ++i) {
      double x = (double(i) - 0.5 * double(rows - row - 1)) * pitch;
      scene.bodies.push_back(dynamic_body(0, {float(x), float(half * double(1 + 2 * row)), 0}, 1));
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
  scene.materials[0].restitution = float(number(v, "restitution"));
  scene.shapes = {sphere_shape(float(radius))};
  add_ground(scene);
  int64_t side = 1;
  while (side * side * side < n) ++side;
  CellGrid grid{side, 2 * (radius + jitter) * 1.001, number(v, "height") + radius + jitter};
  for (int64_t i = 0; i < n; ++i) scene.bodies.push_back(dynamic_body(0, grid.place(i, jitter, random), 1));
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

/* Four static boxes around |x|, |z| <= inner, as high as a third of the yard's width. */
void add_walls(Scene &scene, double inner)
{
  float half_height = float(inner / 3), thick = 0.5f, far = float(inner) + thick;
  auto first = uint32_t(scene.shapes.size());
  scene.shapes.push_back(box_shape(thick, half_height, float(inner) + 2 * thick));
  scene.shapes.push_back(box_shape(float(inner) + 2 * thick, half_height, thick));
  for (int side = 0; side < 4; ++side) {
    Body wall;
    wall.name = "wall";
    wall.motion = Motion::fixed;
    wall.shape = first + (side >= 2);
    wall.position = {0, half_height, 0};
    wall.position[side < 2 ? 0 : 2] = side % 2 ? far : -far;
    scene.bodies.push_back(wall);
  }
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
  int64_t side = 1;
  while (side * side * side < n) ++side;
  CellGrid grid{side, 2 * (largest_radius + jitter), largest_radius + jitter};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(side) + 0.5);
  for (int64_t i = 0; i < n; ++i) {
    uint32_t shape = random.below(movable), material = random.below(uint32_t(scene.materials.size()));
    double density = random.uniform(200, 2000);
    Body body = dynamic_body(shape, grid.place(i, jitter, random), float(density * volume(scene.shapes[shape])));
    body.material = material;
    body.orientation = random.orientation();
    scene.bodies.push_back(body);
  }
  return scene;
}

/* --- the rows -------------------------------------------------------------------------------- */

const SceneParameter seed{"seed", integer, 1, 0, 4294967295.0, "start of the random numbers"};
const SceneParameter half_extent{"half_extent", real, 0.5, 0.001, 1000, "half the edge of a box, m"};
const double most = double(most_bodies - 5);

std::vector<BuiltInScene> simple_scenes()
{
  /* 360 columns are as many as the ground of half extent 400 holds. */
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
    for (BuiltInScene &scene : structure_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : talk_scenes()) all.push_back(std::move(scene));
    for (BuiltInScene &scene : closed_form_scenes()) all.push_back(std::move(scene));
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
  throw InputError(fmt::format("unknown scene '{}'; built-in scenes: {}; scene files end in .json, .gltf or .glb", name,
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

std::string lower_extension(const std::string &path)
{
  size_t dot = path.rfind('.');
  if (dot == std::string::npos) return "";
  std::string extension = path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return extension;
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
  uint64_t count = spec.scene->body_count(spec.values);
  if (count > most_bodies)
    throw InputError(fmt::format("scene {}: {} bodies; at most {} are possible", text, count, most_bodies));
  return spec;
}

Scene build_scene(const SceneSpec &spec)
{
  Scene scene = spec.scene->build(spec.values);
  scene.name = describe(spec);
  validate(scene, scene.name);
  return scene;
}

Scene load_scene(const std::string &spec_or_path)
{
  std::string extension = lower_extension(spec_or_path);
  if (extension == ".json") return read_scene_json(spec_or_path);
  if (extension == ".gltf" || extension == ".glb") return read_scene_gltf(spec_or_path);
  return build_scene(parse_scene_spec(spec_or_path));
}

} // namespace tandem
