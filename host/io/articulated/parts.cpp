/* parts.cpp - limits, hulls and checked numbers of robots; see parts.h. */
#include "host/io/articulated/parts.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "host/io/obj/mesh.h"
#include "host/io/stl/mesh.h"

namespace tandem {
namespace {

constexpr float half_turn = 3.1415927f;
constexpr double largest_angle = 1e6;

void require_order(const XmlElement &element, double lower, double upper)
{
  if (lower > upper)
    element.fail(fmt::format("limits from {:g} to {:g}; the lower one must be at most the upper one", lower, upper));
}

std::string ending_of(const std::string &name)
{
  std::string ending = name.substr(std::min(name.rfind('.'), name.size()));
  for (char &c : ending)
    if (c >= 'A' && c <= 'Z') c = char(c + 'a' - 'A');
  return ending;
}

} // namespace

void set_angle_limits(const XmlElement &element, double lower, double upper, XmlNotes &notes, JointAxis &axis)
{
  require_order(element, lower, upper);
  if (upper - lower >= 2 * std::numbers::pi) return notes.add(element, "limits of a whole turn or more are none");
  if (lower >= std::numbers::pi || upper <= -std::numbers::pi)
    element.fail(fmt::format("limits from {:g} to {:g} rad; angles count from -pi to pi", lower, upper));
  axis.lower = std::max(round_to_float(lower), -half_turn);
  axis.upper = std::min(round_to_float(upper), half_turn);
  if (lower < -double{half_turn} || upper > double{half_turn})
    notes.add(element, "a limit beyond half a turn is at half a turn");
}

void set_way_limits(const XmlElement &element, double lower, double upper, JointAxis &axis)
{
  require_order(element, lower, upper);
  axis.lower = round_to_float(lower);
  axis.upper = round_to_float(upper);
}

bool is_mesh_file(const std::string &name) { return ending_of(name) == ".obj" || ending_of(name) == ".stl"; }

Shape hull_of_file(const XmlElement &element, const std::string &name, const Vec3 &scale, OutsideFiles outside)
{
  if (!is_mesh_file(name)) element.fail(fmt::format("\"{}\" is no mesh that is read; .obj and .stl are", name));
  const std::string text = read_file_beside(*element.file, name, outside, element.place());
  const std::string where = fmt::format("{}: {}", element.place(), name);
  const ObjMesh mesh = ending_of(name) == ".stl" ? parse_stl(text, where) : parse_obj(text, where);
  return hull_shape(scaled(mesh.vertices, scale, where), where);
}

double checked_angle(const XmlElement &element, const char *key, double angle)
{
  if (!(std::abs(angle) <= largest_angle))
    element.fail(fmt::format("{}: {:g} rad; an angle of at most 1e6 rad is needed", key, angle));
  return angle;
}

float checked_length(const XmlElement &element, const char *what, double length)
{
  if (!(length > 0) || !(length <= double{longest_length}) || round_to_float(length) == 0)
    element.fail(
        fmt::format("{} is {:g} m; more than 0 and at most {:g} is needed", what, length, double{longest_length}));
  return round_to_float(length);
}

Vector checked_axis(const XmlElement &element, const char *key, const Double3 &axis)
{
  const Vector unit = vector_of(axis).normalized();
  if (!(std::abs(unit.squared_norm() - 1) < 1e-6))
    element.fail(
        fmt::format("{} is {:g} {:g} {:g}; a vector of some length is needed", key, axis[0], axis[1], axis[2]));
  return unit;
}

MassProperties placed_mass(const MassProperties &mass, const RigidFrame &frame)
{
  return placed(mass, frame.rotation, array_of(frame.position));
}

} // namespace tandem
