/* compiler.cpp - reads <compiler> and <default>, and turns written in five ways; see compiler.h. */
#include "host/io/mjcf/compiler.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

namespace tandem {
namespace {

constexpr size_t most_attributes = 1'000'000; /* of all classes, with what they inherit */
constexpr const char *turns[] = {"quat", "axisangle", "euler", "xyaxes", "zaxis"};

/* One of the words, by its place among them. */
size_t word_of(const XmlElement &element, const char *key, std::span<const char *const> words)
{
  const std::string text = element.needed_text(key);
  std::string all;
  for (size_t k = 0; k < words.size(); ++k) {
    if (text == words[k]) return k;
    all += fmt::format("{}{}", k == 0 ? "" : ", ", words[k]);
  }
  element.fail(fmt::format("{} is \"{}\"; one of {} is needed", key, text, all));
}

Rotation rotation_of_quat(const XmlElement &element, const std::vector<double> &wxyz)
{
  const double length = std::sqrt(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3]);
  if (!(length > 1e-9)) element.fail("quat is 0; four numbers w x y z of some length are needed");
  return unit(Rotation{wxyz[1], wxyz[2], wxyz[3], wxyz[0]});
}

/* The shortest turn that takes z there. */
Rotation rotation_of_z(const Vector &axis)
{
  if (axis.z < -1 + 1e-12) return {1, 0, 0, 0};
  const Vector across = Vector(0, 0, 1).cross(axis);
  return unit(Rotation{across.x, across.y, across.z, 1 + axis.z});
}

Rotation rotation_of_xy(const XmlElement &element, const std::vector<double> &axes)
{
  const Vector x = checked_axis(element, "xyaxes", {axes[0], axes[1], axes[2]}),
               y = checked_axis(element, "xyaxes", {axes[3], axes[4], axes[5]});
  if (x.cross(y).norm() < 1e-6) element.fail("xyaxes are parallel; two axes across each other are needed");
  return rotation_of_axes(x, y);
}

/* Letters in lower case turn about the axes that have turned before, others about those of the outer frame. */
Rotation rotation_of_euler(const XmlElement &element, const MjcfCompiler &compiler)
{
  const Double3 angles = *element.vector("euler");
  Rotation result{0, 0, 0, 1};
  for (size_t k = 0; k < 3; ++k) {
    const char letter = compiler.eulerseq[k];
    const bool moving = letter >= 'x';
    const int axis = letter - (moving ? 'x' : 'X');
    const double angle = checked_angle(element, "euler", compiler.angle(angles[k]));
    const Rotation turned = rotation_about({axis == 0 ? 1. : 0., axis == 1 ? 1. : 0., axis == 2 ? 1. : 0.}, angle);
    result = moving ? product_of(result, turned) : product_of(turned, result);
  }
  return unit(result);
}

bool is_turn(const std::string &key)
{
  return std::any_of(std::begin(turns), std::end(turns), [&](const char *turn) { return key == turn; });
}

/* Elements of <actuator> are ways to write one: what any of them says of these in a class holds for all. */
constexpr const char *actuators[] = {"general",  "motor",  "position", "velocity", "intvelocity",
                                     "cylinder", "damper", "muscle",   "adhesion"};
constexpr const char *of_all_actuators[] = {"ctrllimited", "ctrlrange", "forcelimited", "forcerange", "gear"};

/* As MuJoCo has it, 0 0 is no range unless the file says that it limits. */
bool is_no_range(const std::vector<double> &range) { return range[0] == 0 && range[1] == 0; }

bool is_among(std::span<const char *const> names, const std::string &name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

void MjcfCompiler::read(const XmlElement &compiler, XmlNotes &notes)
{
  constexpr const char *known[] = {"angle",    "coordinate",      "eulerseq",  "meshdir",
                                   "assetdir", "inertiafromgeom", "autolimits"};
  constexpr const char *angles[] = {"degree", "radian"}, *coordinates[] = {"local"},
                       *inertias[] = {"auto", "true", "false"};
  notes.add_other_attributes(compiler, known);
  if (compiler.has("angle")) degrees = word_of(compiler, "angle", angles) == 0;
  if (compiler.has("coordinate")) word_of(compiler, "coordinate", coordinates);
  if (compiler.has("inertiafromgeom")) {
    const size_t word = word_of(compiler, "inertiafromgeom", inertias);
    inertia = word == 0 ? automatic : word == 1 ? from_geoms : from_inertial;
  }
  autolimits = compiler.boolean_or("autolimits", autolimits);
  eulerseq = compiler.text("eulerseq").value_or(eulerseq);
  if (eulerseq.size() != 3 || eulerseq.find_first_not_of("xyzXYZ") != std::string::npos)
    compiler.fail("eulerseq is no three letters of x, y, z, X, Y and Z");
  for (const char *key : {"assetdir", "meshdir"}) meshdir = compiler.text(key).value_or(meshdir);
}

double MjcfCompiler::angle(double x) const { return degrees ? x * (std::numbers::pi / 180) : x; }

RigidFrame MjcfCompiler::frame_of(const XmlElement &element) const
{
  RigidFrame frame;
  frame.position = vector_of(element.vector_or("pos", {0, 0, 0}));
  size_t given = 0;
  for (const char *turn : turns) given += element.has(turn) ? 1 : 0;
  if (given > 1) element.fail("one of quat, axisangle, euler, xyaxes and zaxis is needed, not several");
  if (element.has("quat")) frame.rotation = rotation_of_quat(element, element.numbers("quat", 4, 4));
  if (element.has("euler")) frame.rotation = rotation_of_euler(element, *this);
  if (element.has("xyaxes")) frame.rotation = rotation_of_xy(element, element.numbers("xyaxes", 6, 6));
  if (element.has("zaxis")) frame.rotation = rotation_of_z(checked_axis(element, "zaxis", *element.vector("zaxis")));
  if (element.has("axisangle")) {
    const std::vector<double> four = element.numbers("axisangle", 4, 4);
    frame.rotation = rotation_about(checked_axis(element, "axisangle", {four[0], four[1], four[2]}),
                                    checked_angle(element, "axisangle", angle(four[3])));
  }
  return frame;
}

bool MjcfCompiler::is_limited(const XmlElement &element, const char *limited, const char *range) const
{
  const std::string text = element.text(limited).value_or("auto");
  if (text == "auto") return autolimits && element.has(range) && !is_no_range(element.numbers(range, 2, 2));
  const bool is = element.boolean_or(limited, false);
  if (is && !element.has(range)) element.fail(fmt::format("{} is true, and {} is missing", limited, range));
  return is;
}

void MjcfDefaults::read(const XmlElement &top)
{
  const std::string name = top.text("class").value_or("main");
  if (name != "main") top.fail(fmt::format("class \"{}\" is in no other; the outermost is \"main\"", name));
  read_class(top, name, classes_["main"]);
}

void MjcfDefaults::read_class(const XmlElement &element, const std::string &name, Class inherited)
{
  for (const XmlElement &child : element.children)
    for (const auto &[key, value] : child.attributes) {
      if (child.name == "default") break;
      inherited[child.name][key] = value;
      if (!is_among(actuators, child.name) || !is_among(of_all_actuators, key)) continue;
      for (const char *other : actuators) inherited[other][key] = value;
    }
  for (const auto &[of_element, attributes] : inherited) inherited_ += attributes.size();
  if (inherited_ > most_attributes)
    element.fail(
        fmt::format("the classes up to here have more than {} attributes, inherited ones included", most_attributes));
  classes_[name] = inherited;
  for (const XmlElement *inner : element.children_named("default")) {
    const std::string inner_name = inner->needed_text("class");
    if (classes_.count(inner_name))
      inner->fail(fmt::format("class \"{}\" stands twice; names are needed once", inner_name));
    read_class(*inner, inner_name, inherited);
  }
}

XmlElement MjcfDefaults::completed(const XmlElement &element, const std::string &class_of_body) const
{
  const std::string name = element.text("class").value_or(class_of_body.empty() ? "main" : class_of_body);
  const auto found = classes_.find(name);
  if (found == classes_.end()) element.fail(fmt::format("class \"{}\" does not exist in this file", name));
  XmlElement result;
  result.name = element.name;
  result.file = element.file;
  result.line = element.line;
  result.attributes = element.attributes;
  const auto added = found->second.find(element.name);
  if (added == found->second.end()) return result;
  const bool is_turned = std::any_of(element.attributes.begin(), element.attributes.end(),
                                     [](const auto &attribute) { return is_turn(attribute.first); });
  for (const auto &[key, value] : added->second)
    if (key != "class" && !(is_turned && is_turn(key))) result.attributes.emplace(key, value);
  return result;
}

} // namespace tandem
