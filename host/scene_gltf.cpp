/* scene_gltf.cpp - from a glTF node tree to a flat list of bodies.
 *
 * tinygltf parses the file; the JSON of the two extensions goes through the same strict reader as
 * our own format. The tree is walked once, depth first; a node becomes a body when it has a collider.
 *
 *   node matrices  M = parent · T · R · S   -> position   = last column
 *                                           -> scale      = lengths of the columns  -> shape size
 *                                           -> orientation = columns / lengths      (shear is refused)
 *
 * After the extension texts KHR_implicit_shapes and KHR_physics_rigid_bodies (Khronos, drafts).
 */
#include "host/scene_gltf.h"

#include "host/json_reader.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <tiny_gltf.h>

namespace tandem {
namespace {

constexpr const char *shapes_extension = "KHR_implicit_shapes";
constexpr const char *bodies_extension = "KHR_physics_rigid_bodies";
constexpr double default_density = 1000; /* kg/m³, for motions without a mass */

/* --- parsing the file ------------------------------------------------------------------------- */

bool ignore_image(tinygltf::Image *, const int, std::string *, std::string *, int, int, const unsigned char *, int,
                  void *)
{
  return true;
}

std::string first_line(const std::string &text)
{
  size_t start = text.find_first_not_of(" \n");
  return start == std::string::npos ? "not a readable glTF 2.0 file"
                                    : text.substr(start, text.find('\n', start) - start);
}

tinygltf::Model parse_model(const std::string &path)
{
  std::string text = read_file(path), error, warning;
  bool binary = text.compare(0, 4, "glTF") == 0;
  if (!binary) parse_json(text, path); /* for line and column */
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(ignore_image, nullptr);
  parser.SetStoreOriginalJSONForExtrasAndExtensions(true);
  tinygltf::Model model;
  bool parsed = false;
  try {
    parsed = binary ? parser.LoadBinaryFromFile(&model, &error, &warning, path)
                    : parser.LoadASCIIFromFile(&model, &error, &warning, path);
  } catch (const std::exception &exception) { /* the JSON library under it reports wrong types so */
    error = exception.what();
  }
  if (!parsed) throw InputError(fmt::format("{}: {}", path, first_line(error)));
  return model;
}

void check_extensions(const tinygltf::Model &model, const std::string &where)
{
  for (const std::string &name : model.extensionsRequired)
    if (name != shapes_extension && name != bodies_extension)
      throw InputError(fmt::format("{}: required extension {} is not supported yet; {} and {} are", where, name,
                                   shapes_extension, bodies_extension));
}

/* The "extensions" object of the document or of a node; empty when there is none. */
nlohmann::json extensions_of(const std::string &original, const std::string &where)
{
  nlohmann::json extensions = original.empty() ? nlohmann::json() : parse_json(original, where);
  if (extensions.is_null()) extensions = nlohmann::json::object();
  if (!extensions.is_object()) throw InputError(fmt::format("{}: extensions is not an object", where));
  return extensions;
}

/* --- transforms ------------------------------------------------------------------------------- */

struct Transform {
  double column[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double translation[3] = {0, 0, 0};
};

Transform operator*(const Transform &a, const Transform &b)
{
  Transform product;
  for (int row = 0; row < 3; ++row) {
    product.translation[row] = a.translation[row];
    for (int k = 0; k < 3; ++k) product.translation[row] += a.column[k][row] * b.translation[k];
    for (int j = 0; j < 3; ++j) {
      product.column[j][row] = 0;
      for (int k = 0; k < 3; ++k) product.column[j][row] += a.column[k][row] * b.column[j][k];
    }
  }
  return product;
}

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double determinant(const Transform &t)
{
  const double *a = t.column[0], *b = t.column[1], *c = t.column[2];
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

void rotation_columns(const std::vector<double> &quaternion, Transform &t)
{
  double x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
  double s = 2 / (x * x + y * y + z * z + w * w);
  double columns[3][3] = {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
                          {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
                          {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)}};
  std::copy(&columns[0][0], &columns[0][0] + 9, &t.column[0][0]);
}

/* Of a rotation matrix; the largest component is computed first, so that nothing is divided by a small number. */
Quat quaternion_of(const double m[3][3])
{
  double trace = m[0][0] + m[1][1] + m[2][2], q[4];
  if (trace > 0) {
    double s = 2 * std::sqrt(1 + trace);
    q[0] = (m[1][2] - m[2][1]) / s, q[1] = (m[2][0] - m[0][2]) / s, q[2] = (m[0][1] - m[1][0]) / s, q[3] = s / 4;
  } else {
    int i = m[1][1] > m[0][0] ? 1 : 0;
    if (m[2][2] > m[i][i]) i = 2;
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double s = 2 * std::sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    q[i] = s / 4, q[j] = (m[i][j] + m[j][i]) / s, q[k] = (m[i][k] + m[k][i]) / s, q[3] = (m[j][k] - m[k][j]) / s;
  }
  double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {float(q[0] / length), float(q[1] / length), float(q[2] / length), float(q[3] / length)};
}

/* --- the walk over the nodes ------------------------------------------------------------------ */

struct Visit {
  int node;
  Transform parent;
  int motion_ancestor;   /* -1: none */
  int animated_ancestor; /* -1: none */
};

class Loader {
public:
  Loader(const tinygltf::Model &model, const std::string &where);
  Scene load();

private:
  std::string node_label(int node) const;
  [[noreturn]] void refuse(int node, const std::string &what) const;

  void read_materials(const JsonValue &document);
  void read_filters(const JsonValue &document);
  std::vector<int> root_nodes() const;
  Transform local_transform(int index) const;
  void visit(const Visit &at, std::vector<Visit> &pending);
  void add_body(int index, const Transform &world, const JsonValue &physics);
  bool place(int index, const Transform &world, bool moves, Body &body, Vec3 &scale) const;
  uint32_t read_shape(const JsonValue &geometry, const Vec3 &scale);
  void read_motion(const JsonValue &motion, const Transform &world, Body &body) const;
  void read_inertia(const JsonValue &motion, Body &body) const;
  void read_velocities(const JsonValue &motion, const Transform &world, Body &body) const;
  double volume_of(const Body &body) const;

  const tinygltf::Model &model_;
  std::string where_;
  nlohmann::json shapes_, bodies_; /* the document's two extensions */
  std::set<int> animated_;
  std::set<int> visited_;
  struct Filter {
    uint32_t group = 1, mask = 0xffffffffu;
  };
  std::vector<Filter> filters_;
  std::map<std::pair<uint32_t, Vec3>, uint32_t> shape_index_;
  Scene scene_;
};

Loader::Loader(const tinygltf::Model &model, const std::string &where) : model_(model), where_(where)
{
  nlohmann::json document = extensions_of(model.extensions_json_string, where);
  shapes_ = document.value(shapes_extension, nlohmann::json::object());
  bodies_ = document.value(bodies_extension, nlohmann::json::object());
  for (const tinygltf::Animation &animation : model.animations)
    for (const tinygltf::AnimationChannel &channel : animation.channels)
      if (channel.target_path != "weights") animated_.insert(channel.target_node);
}

std::string Loader::node_label(int node) const
{
  const std::string &name = model_.nodes[size_t(node)].name;
  return name.empty() ? fmt::format("node {}", node) : fmt::format("node '{}'", name);
}

void Loader::refuse(int node, const std::string &what) const
{
  throw InputError(fmt::format("{}: {}: {}", where_, node_label(node), what));
}

/* The extension's rule for two materials takes "average" before "minimum" and so on; a material that
 * names no rule yields to one that does, as our geometric mean does. */
Combine read_combine(const JsonValue &material, const char *key)
{
  static constexpr const char *names[] = {"average", "minimum", "maximum", "multiply"};
  std::optional<JsonValue> rule = material.find(key);
  return rule ? Combine(rule->choice(names)) : Combine::geometric_mean;
}

void Loader::read_materials(const JsonValue &document)
{
  static constexpr const char *keys[] = {"staticFriction",  "dynamicFriction",    "restitution",
                                         "frictionCombine", "restitutionCombine", "name",
                                         "extras",          "extensions"};
  scene_.materials[0].name = "default";
  scene_.materials[0].restitution_combine = Combine::geometric_mean;
  std::optional<JsonValue> list = document.find("physicsMaterials");
  for (size_t i = 0; list && i < list->array_size(); ++i) {
    JsonValue json = list->element(i);
    json.only_keys(keys);
    Material material;
    if (auto name = json.find("name")) material.name = name->text();
    if (auto friction = json.find("staticFriction")) material.static_friction = friction->number();
    if (auto friction = json.find("dynamicFriction")) material.dynamic_friction = friction->number();
    if (auto restitution = json.find("restitution")) material.restitution = restitution->number();
    material.friction_combine = read_combine(json, "frictionCombine");
    material.restitution_combine = read_combine(json, "restitutionCombine");
    scene_.materials.push_back(material);
  }
}

/* --- collision filters ------------------------------------------------------------------------ */

using Systems = std::set<std::string>;

struct FilterText {
  Systems member_of, listed;
  enum { collides_with_all, only_with_listed, not_with_listed } rule = collides_with_all;

  /* Does a collider that is in `systems` pass this filter? One in no system is in no list. */
  bool accepts(const Systems &systems) const
  {
    bool all_listed = !systems.empty() && std::includes(listed.begin(), listed.end(), systems.begin(), systems.end());
    return rule == collides_with_all || all_listed == (rule == only_with_listed);
  }
};

Systems read_systems(const JsonValue &list)
{
  Systems systems;
  for (size_t i = 0; i < list.array_size(); ++i) systems.insert(list.element(i).text());
  return systems;
}

FilterText read_filter(const JsonValue &json)
{
  static constexpr const char *keys[] = {"collisionSystems", "collideWithSystems", "notCollideWithSystems", "name",
                                         "extras",           "extensions"};
  json.only_keys(keys);
  FilterText filter;
  if (auto list = json.find("collisionSystems")) filter.member_of = read_systems(*list);
  auto only = json.find("collideWithSystems"), except = json.find("notCollideWithSystems");
  if (only && except) json.fail("collideWithSystems and notCollideWithSystems exclude each other");
  if (only || except) filter.listed = read_systems(only ? *only : *except);
  if (only) filter.rule = FilterText::only_with_listed;
  if (except) filter.rule = FilterText::not_with_listed;
  return filter;
}

/* The rule asks whether ALL systems of a collider are listed; bits can only ask for ANY. So each
 * combination of systems that occurs gets a bit of its own, which is exact. Bit 0: in no system. */
void Loader::read_filters(const JsonValue &document)
{
  std::vector<FilterText> texts;
  std::optional<JsonValue> list = document.find("collisionFilters");
  for (size_t i = 0; list && i < list->array_size(); ++i) texts.push_back(read_filter(list->element(i)));
  std::vector<Systems> combinations{Systems{}};
  for (const FilterText &text : texts) {
    auto at = std::find(combinations.begin(), combinations.end(), text.member_of);
    if (at == combinations.end()) at = combinations.insert(at, text.member_of);
    if (combinations.size() > 32)
      list->fail("more than 31 different combinations of collision systems are not supported yet");
    filters_.push_back({uint32_t(1) << (at - combinations.begin()), 0});
  }
  for (size_t i = 0; i < texts.size(); ++i)
    for (size_t bit = 0; bit < combinations.size(); ++bit)
      if (texts[i].accepts(combinations[bit])) filters_[i].mask |= uint32_t(1) << bit;
}

/* --- the tree --------------------------------------------------------------------------------- */

std::vector<int> Loader::root_nodes() const
{
  if (!model_.scenes.empty()) {
    int chosen = model_.defaultScene < 0 ? 0 : model_.defaultScene;
    if (size_t(chosen) >= model_.scenes.size())
      throw InputError(
          fmt::format("{}: scene {} does not exist; the file has {}", where_, chosen, model_.scenes.size()));
    return model_.scenes[size_t(chosen)].nodes;
  }
  std::vector<bool> is_child(model_.nodes.size());
  for (const tinygltf::Node &node : model_.nodes)
    for (int child : node.children)
      if (child >= 0 && size_t(child) < is_child.size()) is_child[size_t(child)] = true;
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(int(i));
  return roots;
}

Transform Loader::local_transform(int index) const
{
  const tinygltf::Node &node = model_.nodes[size_t(index)];
  auto has = [&](const std::vector<double> &values, size_t size, const char *name) {
    if (!values.empty() && values.size() != size)
      refuse(index, fmt::format("{} has {} numbers; {} are needed", name, values.size(), size));
    return !values.empty();
  };
  Transform local;
  if (has(node.matrix, 16, "matrix")) {
    for (int j = 0; j < 3; ++j)
      for (int row = 0; row < 3; ++row) local.column[j][row] = node.matrix[size_t(4 * j + row)];
    for (int row = 0; row < 3; ++row) local.translation[row] = node.matrix[size_t(12 + row)];
    return local;
  }
  if (has(node.rotation, 4, "rotation")) {
    double length_squared = 0;
    for (double x : node.rotation) length_squared += x * x;
    if (!(length_squared > 0.99 && length_squared < 1.01)) refuse(index, "rotation is not a quaternion of length 1");
    rotation_columns(node.rotation, local);
  }
  if (has(node.scale, 3, "scale"))
    for (int j = 0; j < 3; ++j)
      for (double &x : local.column[j]) x *= node.scale[size_t(j)];
  if (has(node.translation, 3, "translation")) std::copy_n(node.translation.begin(), 3, local.translation);
  return local;
}

Scene Loader::load()
{
  JsonValue bodies(bodies_, where_, std::string("extensions.") + bodies_extension);
  static constexpr const char *keys[] = {"physicsMaterials", "collisionFilters", "physicsJoints", "extras",
                                         "extensions"};
  bodies.only_keys(keys);
  scene_.name = where_;
  scene_.gravity = {0, -9.81f, 0};
  read_materials(bodies);
  read_filters(bodies);
  std::vector<Visit> pending;
  std::vector<int> roots = root_nodes();
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending.push_back({*root, {}, -1, -1});
  while (!pending.empty()) {
    Visit next = pending.back();
    pending.pop_back();
    visit(next, pending);
  }
  if (scene_.bodies.empty())
    throw InputError(
        fmt::format("{}: no node has a collider ({}); there is nothing to simulate", where_, bodies_extension));
  validate(scene_, where_);
  return std::move(scene_);
}

void Loader::visit(const Visit &at, std::vector<Visit> &pending)
{
  if (at.node < 0 || size_t(at.node) >= model_.nodes.size())
    throw InputError(fmt::format("{}: node {} does not exist; the file has {}", where_, at.node, model_.nodes.size()));
  if (!visited_.insert(at.node).second) refuse(at.node, "has two parents; a node tree is needed");
  const tinygltf::Node &node = model_.nodes[size_t(at.node)];
  Visit below = at;
  below.parent = at.parent * local_transform(at.node);
  if (animated_.count(at.node)) below.animated_ancestor = at.node;
  std::string where = where_ + ": " + node_label(at.node);
  nlohmann::json extensions = extensions_of(node.extensions_json_string, where);
  if (extensions.contains(bodies_extension)) {
    JsonValue physics(extensions[bodies_extension], where);
    static constexpr const char *keys[] = {"motion", "collider", "trigger", "joint", "extras", "extensions"};
    physics.only_keys(keys);
    bool has_motion = physics.find("motion").has_value(), has_collider = physics.find("collider").has_value();
    if (physics.find("joint")) physics.fail("a joint is not supported yet");
    if (physics.find("trigger")) physics.fail("a trigger is not supported yet");
    if (has_motion && !has_collider)
      physics.fail("a motion without a collider of its own (a compound of colliders further down, or a body without "
                   "shape) is not supported yet");
    if (has_collider && !has_motion && at.motion_ancestor >= 0)
      physics.fail(fmt::format("a collider below the motion of {} (a compound collider) is not supported yet",
                               node_label(at.motion_ancestor)));
    if ((has_motion || has_collider) && below.animated_ancestor >= 0)
      physics.fail("an animated rigid body is not supported yet");
    if (has_collider) add_body(at.node, below.parent, physics);
    if (has_motion) below.motion_ancestor = at.node;
  }
  for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
    below.node = *child;
    pending.push_back(below);
  }
}

/* --- one body --------------------------------------------------------------------------------- */

void Loader::add_body(int index, const Transform &world, const JsonValue &physics)
{
  static constexpr const char *collider_keys[] = {"geometry", "physicsMaterial", "collisionFilter", "extras",
                                                  "extensions"};
  JsonValue collider = physics.member("collider");
  collider.only_keys(collider_keys);
  std::optional<JsonValue> motion = physics.find("motion");
  Body body;
  Vec3 scale;
  body.name = model_.nodes[size_t(index)].name;
  if (body.name.empty()) body.name = fmt::format("node {}", index);
  if (!place(index, world, motion.has_value(), body, scale)) return;
  body.shape = read_shape(collider.member("geometry"), scale);
  if (auto material = collider.find("physicsMaterial")) {
    body.material = material->unsigned_integer() + 1;
    if (body.material == 0 || body.material >= scene_.materials.size())
      material->fail(fmt::format("material {} does not exist; the file has {}", material->unsigned_integer(),
                                 scene_.materials.size() - 1));
  }
  if (auto filter = collider.find("collisionFilter")) {
    uint32_t chosen = filter->unsigned_integer();
    if (chosen >= filters_.size())
      filter->fail(fmt::format("filter {} does not exist; the file has {}", chosen, filters_.size()));
    body.filter_group = filters_[chosen].group;
    body.filter_mask = filters_[chosen].mask;
  }
  body.motion = Motion::fixed;
  if (motion) read_motion(*motion, world, body);
  if (body.motion == Motion::dynamic && scene_.shapes[body.shape].type == ShapeType::half_space)
    refuse(index, "a plane that moves freely is not supported yet");
  scene_.bodies.push_back(body);
}

/* Splits the world matrix. False: scaled to nothing, which disables the collider. */
bool Loader::place(int index, const Transform &world, bool moves, Body &body, Vec3 &scale) const
{
  Transform rotation = world;
  double length[3];
  for (int j = 0; j < 3; ++j) length[j] = std::sqrt(dot(world.column[j], world.column[j]));
  bool disabled = length[0] == 0 && length[1] == 0 && length[2] == 0;
  if (disabled && !moves) return false;
  for (int j = 0; j < 3; ++j) {
    if (!(length[j] > 0) || !std::isfinite(length[j]))
      refuse(index, fmt::format("its scale is {} along axis {}", length[j], j));
    for (double &x : rotation.column[j]) x /= length[j];
    scale[size_t(j)] = float(length[j]);
  }
  for (int j = 0; j < 3; ++j)
    if (std::abs(dot(rotation.column[j], rotation.column[(j + 1) % 3])) > 1e-4)
      refuse(index, "a sheared collider (a rotation below an uneven scale) is not supported yet");
  /* Mirrored along X: no shape we know changes by that, and +Y, the plane's normal, stays. */
  if (determinant(rotation) < 0)
    for (double &x : rotation.column[0]) x = -x;
  body.orientation = quaternion_of(rotation.column);
  for (size_t row = 0; row < 3; ++row) body.position[row] = float(world.translation[row]);
  return true;
}

Shape read_plane(const JsonValue &json)
{
  static constexpr const char *keys[] = {"doubleSided", "sizeX", "sizeZ", "extras", "extensions"};
  json.only_keys(keys);
  if (json.find("sizeX") || json.find("sizeZ")) json.fail("a finite plane is not supported yet");
  if (auto double_sided = json.find("doubleSided"); double_sided && double_sided->boolean())
    json.fail("a double-sided plane is not supported yet");
  return half_space_shape();
}

Shape read_sphere(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"radius", "extras", "extensions"};
  json.only_keys(keys);
  float smallest = std::min({scale[0], scale[1], scale[2]}), largest = std::max({scale[0], scale[1], scale[2]});
  if (largest > smallest * 1.0001f)
    json.fail(fmt::format("a sphere scaled unevenly ({}, {}, {}) is not supported yet", scale[0], scale[1], scale[2]));
  std::optional<JsonValue> radius = json.find("radius");
  return sphere_shape((radius ? radius->number() : 0.5f) * scale[0]);
}

Shape read_box(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"size", "extras", "extensions"};
  json.only_keys(keys);
  std::optional<JsonValue> size = json.find("size");
  Vec3 edges = size ? size->vec3() : Vec3{1, 1, 1};
  return box_shape(0.5f * edges[0] * scale[0], 0.5f * edges[1] * scale[1], 0.5f * edges[2] * scale[2]);
}

uint32_t Loader::read_shape(const JsonValue &geometry, const Vec3 &scale)
{
  if (geometry.find("node") || geometry.find("mesh"))
    geometry.fail("mesh geometry (and its convex hull) is not supported yet");
  static constexpr const char *keys[] = {"shape", "convexHull", "extras", "extensions"};
  geometry.only_keys(keys);
  static constexpr const char *document_keys[] = {"shapes", "extras", "extensions"};
  JsonValue chosen = geometry.member("shape"),
            document(shapes_, geometry.where(), std::string("extensions.") + shapes_extension);
  document.only_keys(document_keys);
  JsonValue list = document.member("shapes");
  uint32_t index = chosen.unsigned_integer();
  if (index >= list.array_size())
    chosen.fail(fmt::format("shape {} does not exist; the file has {}", index, list.array_size()));
  JsonValue json = list.element(index);
  std::string type = json.member("type").text();
  nlohmann::json empty = nlohmann::json::object();
  Shape shape;
  if (type == "plane") shape = read_plane(json.find("plane").value_or(JsonValue(empty, geometry.where())));
  else if (type == "sphere") shape = read_sphere(json.member("sphere"), scale);
  else if (type == "box") shape = read_box(json.member("box"), scale);
  else geometry.fail(fmt::format("shape type {} is not supported yet; sphere, box and plane are", type));
  auto [at, added] = shape_index_.emplace(std::pair{uint32_t(shape.type), shape.size}, uint32_t(scene_.shapes.size()));
  if (added) scene_.shapes.push_back(shape);
  return at->second;
}

/* --- its motion ------------------------------------------------------------------------------- */

void Loader::read_motion(const JsonValue &motion, const Transform &world, Body &body) const
{
  static constexpr const char *keys[] = {
      "isKinematic",     "mass",          "centerOfMass", "inertiaDiagonal", "inertiaOrientation", "linearVelocity",
      "angularVelocity", "gravityFactor", "extras",       "extensions"};
  motion.only_keys(keys);
  body.motion = Motion::dynamic;
  if (auto centre = motion.find("centerOfMass"); centre && centre->vec3() != Vec3{0, 0, 0})
    centre->fail("a centre of mass beside the node's origin is not supported yet");
  if (auto factor = motion.find("gravityFactor")) body.gravity_factor = factor->number();
  read_velocities(motion, world, body);
  if (auto kinematic = motion.find("isKinematic"); kinematic && kinematic->boolean()) {
    body.motion = Motion::kinematic;
    return;
  }
  std::optional<JsonValue> mass = motion.find("mass");
  body.mass = mass ? mass->number() : float(default_density * volume_of(body));
  read_inertia(motion, body);
  if (mass && body.mass == 0) { /* zero stands for infinity */
    if (body.inertia != Vec3{0, 0, 0}) mass->fail("an infinite mass with a finite inertia is not supported yet");
    body.motion = Motion::kinematic;
    body.mass = 1;
    body.infinite_inertia = false;
  }
}

void Loader::read_inertia(const JsonValue &motion, Body &body) const
{
  if (auto orientation = motion.find("inertiaOrientation")) {
    Quat q = orientation->quat();
    if (std::abs(q[0]) + std::abs(q[1]) + std::abs(q[2]) > 1e-6f)
      orientation->fail("a rotated inertia tensor is not supported yet");
  }
  std::optional<JsonValue> diagonal = motion.find("inertiaDiagonal");
  if (!diagonal) return;
  body.inertia = diagonal->vec3();
  auto zeros = std::count(body.inertia.begin(), body.inertia.end(), 0.0f);
  if (zeros == 3) body.infinite_inertia = true;
  if (zeros == 1 || zeros == 2)
    diagonal->fail("an inertia that is infinite (0) about some axes only is not supported yet");
}

/* Given in node space: turned, but not scaled, to world axes. */
void Loader::read_velocities(const JsonValue &motion, const Transform &world, Body &body) const
{
  Vec3 *targets[] = {&body.linear_velocity, &body.angular_velocity};
  const char *keys[] = {"linearVelocity", "angularVelocity"};
  for (int i = 0; i < 2; ++i) {
    std::optional<JsonValue> json = motion.find(keys[i]);
    Vec3 local = json ? json->vec3() : Vec3{0, 0, 0};
    if (local == Vec3{0, 0, 0}) continue;
    if (determinant(world) < 0) json->fail("a velocity in a mirrored node (negative scale) is not supported yet");
    double turned[3] = {0, 0, 0};
    for (size_t j = 0; j < 3; ++j)
      for (size_t row = 0; row < 3; ++row)
        turned[row] += world.column[j][row] / std::sqrt(dot(world.column[j], world.column[j])) * double(local[j]);
    for (size_t row = 0; row < 3; ++row) (*targets[i])[row] = float(turned[row]);
  }
}

double Loader::volume_of(const Body &body) const
{
  const Shape &shape = scene_.shapes[body.shape];
  double x = shape.size[0], y = shape.size[1], z = shape.size[2];
  return shape.type == ShapeType::sphere ? 4.0 / 3.0 * 3.14159265358979323846 * x * x * x : 8 * x * y * z;
}

} // namespace

Scene read_scene_gltf(const std::string &path)
{
  tinygltf::Model model = parse_model(path);
  check_extensions(model, path);
  return Loader(model, path).load();
}

} // namespace tandem
