/* scene.cpp - the scene file format: one list of fields per record, from which both the reader and the writer follow;
 * see scene.h. */
#include "host/io/json/scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/shape_mass.h"
#include "host/io/json/numbers.h"
#include "host/io/json/reader.h"
#include "host/io/json/shapes.h"
#include "host/io/output_file.h"

namespace tandem {
namespace {

using tandem::same;
using tandem::written; /* beside the overloads of this file */

constexpr const char *axis_names[] = {"x", "y", "z"};
constexpr const char *motion_names[] = {"fixed", "kinematic", "dynamic"};
constexpr const char *combine_names[] = {"average", "minimum", "maximum", "multiply", "geometric_mean"};

std::span<const char *const> names_of(BodyType) { return motion_names; }
std::span<const char *const> names_of(Combine) { return combine_names; }
std::span<const char *const> names_of(JointType) { return joint_type_names(); }
std::span<const char *const> names_of(CouplingType) { return coupling_type_names(); }
std::span<const char *const> names_of(JointCoordinate) { return joint_coordinate_names(); }
std::span<const char *const> names_of(Control) { return control_names(); }

template <typename Field> void each_field(const Material *, Field &&field)
{
  field("name", &Material::name);
  field("static_friction", &Material::static_friction);
  field("dynamic_friction", &Material::dynamic_friction);
  field("restitution", &Material::restitution);
  field("rolling_friction", &Material::rolling_friction);
  field("spinning_friction", &Material::spinning_friction);
  field("friction_combine", &Material::friction_combine);
  field("restitution_combine", &Material::restitution_combine);
}

template <typename Field> void each_field(const Body *, Field &&field)
{
  field("name", &Body::name);
  field("motion", &Body::type);
  field("shape", &Body::shape);
  field("material", &Body::material);
  field("position", &Body::position);
  field("orientation", &Body::orientation);
  field("shape_position", &Body::shape_position);
  field("shape_orientation", &Body::shape_orientation);
  field("linear_velocity", &Body::linear_velocity);
  field("angular_velocity", &Body::angular_velocity);
  field("mass", &Body::mass);
  field("inertia", &Body::inertia);
  field("infinite_inertia", &Body::infinite_inertia);
  field("gravity_factor", &Body::gravity_factor);
  field("linear_damping", &Body::linear_damping);
  field("angular_damping", &Body::angular_damping);
  field("filter_group", &Body::filter_group);
  field("filter_mask", &Body::filter_mask);
  field("trigger", &Body::trigger);
  field("continuous", &Body::continuous);
  field("linear_locks", &Body::linear_locks);
  field("angular_locks", &Body::angular_locks);
  field("max_linear_speed", &Body::max_linear_speed);
  field("max_angular_speed", &Body::max_angular_speed);
  field("user_data", &Body::user_data);
}

template <typename Field> void each_field(const Joint *, Field &&field)
{
  field("name", &Joint::name);
  field("type", &Joint::type);
  field("body_a", &Joint::body_a);
  field("body_b", &Joint::body_b);
  field("position_a", &Joint::position_a);
  field("orientation_a", &Joint::orientation_a);
  field("position_b", &Joint::position_b);
  field("orientation_b", &Joint::orientation_b);
  field("collide", &Joint::collide);
  field("enabled", &Joint::enabled);
  field("break_force", &Joint::break_force);
  field("break_torque", &Joint::break_torque);
  field("held_directions", &Joint::held_directions);
  field("held_rotations", &Joint::held_rotations);
  field("directions", &Joint::directions);
  field("rotations", &Joint::rotations);
}

template <typename Field> void each_field(const JointAxis *, Field &&field)
{
  field("lower", &JointAxis::lower);
  field("upper", &JointAxis::upper);
  field("limit_stiffness", &JointAxis::limit_stiffness);
  field("limit_damping", &JointAxis::limit_damping);
  field("restitution", &JointAxis::restitution);
  field("target_position", &JointAxis::target_position);
  field("target_velocity", &JointAxis::target_velocity);
  field("stiffness", &JointAxis::stiffness);
  field("damping", &JointAxis::damping);
  field("motor", &JointAxis::motor);
  field("force", &JointAxis::force);
  field("max_force", &JointAxis::max_force);
  field("friction", &JointAxis::friction);
  field("max_speed", &JointAxis::max_speed);
}

template <typename Field> void each_field(const Coupling *, Field &&field)
{
  field("name", &Coupling::name);
  field("type", &Coupling::type);
  field("joint_a", &Coupling::joint_a);
  field("joint_b", &Coupling::joint_b);
  field("coordinate_a", &Coupling::coordinate_a);
  field("coordinate_b", &Coupling::coordinate_b);
  field("teeth_a", &Coupling::teeth_a);
  field("teeth_b", &Coupling::teeth_b);
  field("travel", &Coupling::travel);
  field("ratio", &Coupling::ratio);
  field("offset", &Coupling::offset);
  field("only_pulls", &Coupling::only_pulls);
}

template <typename Field> void each_field(const Articulation *, Field &&field)
{
  field("name", &Articulation::name);
  field("joints", &Articulation::joints);
  field("root", &Articulation::root);
  field("armatures", &Articulation::armatures);
}

template <typename Field> void each_field(const Actuator *, Field &&field)
{
  field("name", &Actuator::name);
  field("joint", &Actuator::joint);
  field("axis", &Actuator::axis);
  field("sets", &Actuator::sets);
  field("offset", &Actuator::offset);
  field("factor", &Actuator::factor);
  field("lower", &Actuator::lower);
  field("upper", &Actuator::upper);
}

/* --- reading --------------------------------------------------------------------------------- */

void read_value(const JsonValue &json, std::string &value) { value = json.text(); }
void read_value(const JsonValue &json, float &value) { value = json.number(); }
void read_value(const JsonValue &json, uint32_t &value) { value = json.unsigned_integer(); }
void read_value(const JsonValue &json, int32_t &value)
{
  const double given = json.precise_number();
  if (!(std::abs(given) <= 1e9) || given != std::floor(given))
    json.fail(fmt::format("is {}; a whole number is needed", given));
  value = static_cast<int32_t>(given);
}
void read_value(const JsonValue &json, uint64_t &value) { value = json.long_unsigned_integer(); }
void read_value(const JsonValue &json, bool &value) { value = json.boolean(); }
void read_value(const JsonValue &json, Axes &value)
{
  for (size_t i = 0; i < json.array_size(); ++i)
    (json.element(i).choice(axis_names) == 0   ? value.x
     : json.element(i).choice(axis_names) == 1 ? value.y
                                               : value.z) = true;
}
void read_value(const JsonValue &json, Vec3 &value) { value = json.vec3(); }
void read_value(const JsonValue &json, Point &value) { value = json.point(); }
void read_value(const JsonValue &json, Quat &value) { value = json.quat(); }
template <typename Enum>
requires std::is_enum_v<Enum>
void read_value(const JsonValue &json, Enum &value) { value = Enum(json.choice(names_of(value))); }

void read_value(const JsonValue &json, std::array<JointAxis, 3> &axes);
template <typename Record> void read_value(const JsonValue &json, std::vector<Record> &records);

/* Keys of a record in a file that are none of its fields. */
template <typename Record> std::vector<const char *> further_keys(const Record *) { return {}; }
std::vector<const char *> further_keys(const Body *) { return {"density"}; } /* take_densities */

template <typename Record> void read_value(const JsonValue &json, Record &record) requires requires
{
  each_field(&record, [](auto, auto) {});
}
{
  std::vector<const char *> known;
  each_field(&record, [&](const char *key, auto) { known.push_back(key); });
  for (const char *key : further_keys(&record)) known.push_back(key);
  json.only_keys(known);
  each_field(&record, [&](const char *key, auto member) {
    if (std::optional<JsonValue> found = json.find(key)) read_value(*found, record.*member);
  });
}

template <typename Record> void read_value(const JsonValue &json, std::vector<Record> &records)
{
  records.resize(json.array_size());
  for (size_t i = 0; i < records.size(); ++i) read_value(json.element(i), records[i]);
}

/* Of three axes, those at the end that are as usual may be left away. */
void read_value(const JsonValue &json, std::array<JointAxis, 3> &axes)
{
  if (json.array_size() > axes.size())
    json.fail(fmt::format("has {} entries; x, y and z are needed, or the first of them", json.array_size()));
  for (size_t i = 0; i < json.array_size(); ++i) read_value(json.element(i), axes[i]);
}

void read_shapes(const JsonValue &json, OutsideFiles outside, std::vector<Shape> &shapes)
{
  for (size_t i = 0; i < json.array_size(); ++i) shapes.push_back(read_shape(json.element(i), outside));
}

/* With a density, mass, centre of mass and principal axes are computed from the shape, and the body's frame is moved
 * accordingly. */
void take_density(const JsonValue &json, Scene &scene, Body &body)
{
  static constexpr const char *replaced[] = {"mass", "inertia"};
  for (const char *key : replaced)
    if (json.find(key)) json.fail(fmt::format("\"density\" and \"{}\" exclude each other", key));
  const JsonValue density = json.member("density");
  const Shape &shape = scene.shapes[body.shape];
  if (shape.type == ShapeType::half_space) density.fail("a half_space has no mass; leave it away");
  if (!(density.number() > 0)) density.fail(fmt::format("is {}; a number above 0 is needed", density.number()));
  try {
    take_mass_properties(scene, body);
    body.mass = round_to_float(double(density.number()) * mass_properties_of(shape).mass);
  } catch (const InputError &error) { /* the mesh has no volume */
    density.fail(error.what());
  }
}

void take_densities(const JsonValue &bodies, Scene &scene, const std::string &where)
{
  std::vector<size_t> given;
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    if (bodies.element(i).find("density")) given.push_back(i);
  if (given.empty()) return;
  Scene sound =
      scene; /* the shapes and poses that masses are computed from are validated first, the masses once known */
  for (size_t i : given) sound.bodies[i].type = std::min(sound.bodies[i].type, BodyType::kinematic);
  validate(sound, where);
  for (size_t i : given) take_density(bodies.element(i), scene, scene.bodies[i]);
}

/* A moment of 0 stands for an infinite one, or for that of the shape. */
void take_moments(const JsonValue &bodies, Scene &scene)
{
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    if (const auto moments = bodies.element(i).find("inertia")) scene.bodies[i].inertia = moments->magnitudes();
}

void check_format(const JsonValue &root)
{
  if (!root.find("tandem_scene")) root.fail("\"tandem_scene\": 1 is missing; this is not a Tandem scene");
  JsonValue version = root.member("tandem_scene");
  if (version.unsigned_integer() != 1)
    version.fail(fmt::format("is {}; version 1 is known", version.unsigned_integer()));
}

/* --- writing --------------------------------------------------------------------------------- */

std::string quoted(const std::string &text)
{
  try {
    return nlohmann::json(text).dump();
  } catch (const nlohmann::json::exception &) {
    throw InputError("a name is not valid UTF-8 and cannot be written to JSON");
  }
}

std::string written(const std::string &value) { return quoted(value); }
std::string written(int32_t value) { return fmt::format("{}", value); }
std::string written(uint64_t value) { return fmt::format("{}", value); }
std::string written(const Axes &axes)
{
  std::string text;
  for (const auto &[locked, name] :
       {std::pair(axes.x, axis_names[0]), std::pair(axes.y, axis_names[1]), std::pair(axes.z, axis_names[2])})
    if (locked) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return "[" + text + "]";
}
std::string written(bool value) { return value ? "true" : "false"; }
template <typename Enum>
requires std::is_enum_v<Enum> std::string written(Enum value)
{
  return fmt::format("\"{}\"", names_of(value)[size_t(value)]);
}
template <typename Number> std::string written(const std::vector<Number> &numbers)
{
  std::string text;
  for (const Number number : numbers) text += (text.empty() ? "" : ", ") + written(number);
  return "[" + text + "]";
}
using ThreeAxes = std::array<JointAxis, 3>;
std::string written(const ThreeAxes &axes);
bool same(const ThreeAxes &a, const ThreeAxes &b) { return written(a) == written(b); }

/* Fields that have their default value are omitted, except those that are always written. */
template <typename Record> std::string written_record(const Record &record, std::string text)
{
  static const Record defaults;
  each_field(&record, [&](const char *key, auto member) {
    if (same(record.*member, defaults.*member)) return;
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", key, written(record.*member));
  });
  return "{" + text + "}";
}

std::string written(const Material &material) { return written_record(material, ""); }
std::string written(const Body &body) { return written_record(body, ""); }

std::string written(const ThreeAxes &axes)
{
  std::string text, waiting;
  for (const JointAxis &axis : axes) {
    const std::string entry = written_record(axis, "");
    waiting += (text.empty() && waiting.empty() ? "" : ", ") + entry;
    if (entry == "{}") continue;
    text += waiting;
    waiting.clear();
  }
  return "[" + text + "]";
}

std::string written(const Joint &joint) { return written_record(joint, ""); }
std::string written(const Coupling &coupling) { return written_record(coupling, ""); }
std::string written(const Articulation &articulation) { return written_record(articulation, ""); }
std::string written(const Actuator &actuator) { return written_record(actuator, ""); }

std::string written(const Shape &shape) { return written_shape(shape); }

template <typename Record> void write_list(std::string &text, const char *key, const std::vector<Record> &records)
{
  text += fmt::format(",\n\"{}\": [", key);
  for (size_t i = 0; i < records.size(); ++i) text += (i ? ",\n  " : "\n  ") + written(records[i]);
  text += "]";
}

} // namespace

Scene parse_scene_json(const std::string &text, const std::string &where, OutsideFiles outside)
{
  static constexpr const char *keys[] = {"tandem_scene", "name",   "gravity",   "shapes",        "materials",
                                         "bodies",       "joints", "couplings", "articulations", "actuators"};
  const JsonDocument document = parse_json(text, where);
  const JsonValue root(document.value(), where);
  check_format(root);
  root.only_keys(keys);
  Scene scene;
  if (auto name = root.find("name")) read_value(*name, scene.name);
  if (auto gravity = root.find("gravity")) read_value(*gravity, scene.gravity);
  if (auto materials = root.find("materials")) read_value(*materials, scene.materials);
  read_shapes(root.member("shapes"), outside, scene.shapes);
  read_value(root.member("bodies"), scene.bodies);
  take_moments(root.member("bodies"), scene);
  take_densities(root.member("bodies"), scene, where);
  if (auto joints = root.find("joints")) read_value(*joints, scene.joints);
  if (auto couplings = root.find("couplings")) read_value(*couplings, scene.couplings);
  if (auto articulations = root.find("articulations")) read_value(*articulations, scene.articulations);
  if (auto actuators = root.find("actuators")) read_value(*actuators, scene.actuators);
  validate(scene, where);
  return scene;
}

Scene read_scene_json(const std::string &path, OutsideFiles outside)
{
  return parse_scene_json(read_file(path), path, outside);
}

std::string to_scene_json(const Scene &scene)
{
  validate(scene, scene.name.empty() ? "scene" : scene.name);
  std::string text =
      fmt::format("{{\"tandem_scene\": 1,\n\"name\": {},\n\"gravity\": {}", quoted(scene.name), written(scene.gravity));
  write_list(text, "shapes", scene.shapes);
  write_list(text, "materials", scene.materials);
  write_list(text, "bodies", scene.bodies);
  if (!scene.joints.empty()) write_list(text, "joints", scene.joints);
  if (!scene.couplings.empty()) write_list(text, "couplings", scene.couplings);
  if (!scene.articulations.empty()) write_list(text, "articulations", scene.articulations);
  if (!scene.actuators.empty()) write_list(text, "actuators", scene.actuators);
  return text + "}\n";
}

void write_scene_json(const Scene &scene, const std::string &path)
{
  const std::string text = to_scene_json(scene);
  OutputFile file(path, path);
  file.write(text);
  file.commit();
}

} // namespace tandem
