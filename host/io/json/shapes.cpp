/* shapes.cpp - one reader and one writer for each type of shape; see shapes.h. */
#include "host/io/json/shapes.h"

#include <algorithm>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"
#include "host/io/json/numbers.h"
#include "host/io/obj/mesh.h"

namespace tandem {
namespace {

using tandem::written; /* beside the overloads of this file */

/* The first names stand for the ShapeType at the same index in `types`. A cone is a cylinder and a height field is a
 * mesh, and they are written as such. */
enum Name { sphere, box, half_space, capsule, cylinder, hull, mesh, compound, cone, height_field };
constexpr const char *names[] = {"sphere", "box",  "half_space", "capsule", "cylinder",
                                 "hull",   "mesh", "compound",   "cone",    "height_field"};
constexpr ShapeType types[] = {ShapeType::sphere,   ShapeType::box,  ShapeType::half_space, ShapeType::capsule,
                               ShapeType::cylinder, ShapeType::hull, ShapeType::mesh,       ShapeType::compound,
                               ShapeType::cylinder, ShapeType::mesh};

std::vector<const char *> keys_of(Name name)
{
  switch (name) {
  case sphere: return {"radius", "size"};
  case box: return {"half_extents", "size"};
  case half_space: return {"size"};
  case capsule:
  case cylinder: return {"radius", "radius_bottom", "radius_top", "half_height", "size"};
  case hull: return {"points", "obj", "scale", "size"};
  case mesh: return {"vertices", "triangles", "obj", "scale"};
  case compound: return {"children"};
  case cone: return {"radius", "half_height"};
  case height_field: return {"heights", "columns", "spacing"};
  }
  return {};
}

/* The keys that "size", which gives the three numbers of the record directly, replaces. */
std::vector<const char *> replaced_by_size(Name name)
{
  if (name == sphere) return {"radius"};
  if (name == box) return {"half_extents"};
  if (name == capsule || name == cylinder) return {"radius", "radius_bottom", "radius_top", "half_height"};
  return {};
}

void only_one(const JsonValue &json, const char *first, const char *second)
{
  if (json.find(first) && json.find(second))
    json.fail(fmt::format("\"{}\" and \"{}\" exclude each other", first, second));
}

/* Reads "radius" for both ends, or one radius for each. */
void read_radii(const JsonValue &json, Shape &shape)
{
  std::optional<JsonValue> radius = json.find("radius");
  if (radius && (json.find("radius_bottom") || json.find("radius_top")))
    json.fail("\"radius\" and \"radius_bottom\", \"radius_top\" exclude each other");
  shape.size[0] = radius ? radius->number() : json.member("radius_bottom").number();
  shape.size[2] = radius ? shape.size[0] : json.member("radius_top").number();
  shape.size[1] = json.member("half_height").number();
}

std::vector<Vec3> read_points(const JsonValue &json)
{
  std::vector<Vec3> points(json.array_size());
  for (size_t i = 0; i < points.size(); ++i) points[i] = json.element(i).vec3();
  return points;
}

std::vector<Triangle> read_triangles(const JsonValue &json)
{
  std::vector<Triangle> triangles(json.array_size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    const JsonValue corners = json.element(i);
    if (corners.array_size() != 3)
      corners.fail(fmt::format("has {} numbers; the three vertices of a triangle are needed", corners.array_size()));
    for (size_t k = 0; k < 3; ++k) triangles[i][k] = corners.element(k).unsigned_integer();
  }
  return triangles;
}

ObjMesh read_obj(const JsonValue &json, OutsideFiles outside)
{
  const std::string text = read_file_beside(json.where(), json.text(), outside, json.place());
  return parse_obj(text, fmt::format("{}: {}", json.place(), json.text()));
}

/* A mirroring scale turns a mesh inside out, so its triangles are reversed here. */
void take_scale(const JsonValue &json, std::vector<Vec3> &points, std::vector<Triangle> &triangles)
{
  const std::optional<JsonValue> given = json.find("scale");
  if (!given) return;
  const Vec3 scale = given->magnitudes();
  points = scaled(points, scale, given->place());
  if (scale[0] * scale[1] * scale[2] < 0) triangles = turned_round(triangles);
}

Shape read_hull(const JsonValue &json, OutsideFiles outside)
{
  only_one(json, "points", "obj");
  const std::optional<JsonValue> file = json.find("obj");
  const JsonValue source = file ? *file : json.member("points");
  std::vector<Vec3> points = file ? read_obj(source, outside).vertices : read_points(source);
  std::vector<Triangle> none;
  take_scale(json, points, none);
  return hull_shape(points, source.place());
}

Shape read_mesh(const JsonValue &json, OutsideFiles outside)
{
  only_one(json, "vertices", "obj");
  only_one(json, "triangles", "obj");
  ObjMesh mesh;
  if (const std::optional<JsonValue> file = json.find("obj")) mesh = read_obj(*file, outside);
  else mesh = {read_points(json.member("vertices")), read_triangles(json.member("triangles"))};
  take_scale(json, mesh.vertices, mesh.triangles);
  std::vector<uint32_t> indices;
  for (const Triangle &triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  return mesh_shape(mesh.vertices, indices, json.place());
}

Shape read_height_field(const JsonValue &json)
{
  const JsonValue list = json.member("heights"), spacing = json.member("spacing");
  if (spacing.array_size() != 2) spacing.fail("two numbers are needed: the spacing along x and along z");
  std::vector<float> heights(list.array_size());
  for (size_t i = 0; i < heights.size(); ++i) heights[i] = list.element(i).coordinate();
  return height_field_shape(heights, json.member("columns").unsigned_integer(), spacing.element(0).number(),
                            spacing.element(1).number(), json.place());
}

Child read_child(const JsonValue &json, OutsideFiles outside)
{
  static constexpr const char *keys[] = {"shape",    "position",     "orientation", "density",
                                         "material", "filter_group", "filter_mask"};
  json.only_keys(keys);
  Child child;
  child.shape = read_shape(json.member("shape"), outside);
  if (const auto position = json.find("position")) child.position = position->vec3();
  if (const auto orientation = json.find("orientation")) child.orientation = orientation->quat();
  if (const auto density = json.find("density")) child.density = density->number();
  if (const auto material = json.find("material")) child.material = material->unsigned_integer();
  if (const auto group = json.find("filter_group")) child.filter_group = group->unsigned_integer();
  if (const auto mask = json.find("filter_mask")) child.filter_mask = mask->unsigned_integer();
  return child;
}

Shape read_compound(const JsonValue &children, OutsideFiles outside)
{
  std::vector<Child> list;
  for (size_t i = 0; i < children.array_size(); ++i) list.push_back(read_child(children.element(i), outside));
  return compound_shape(std::move(list));
}

void read_size(const JsonValue &json, Name name, Shape &shape)
{
  if (name == cone) shape = cone_shape(json.member("radius").number(), json.member("half_height").number());
  else if (name == sphere) shape = sphere_shape(json.member("radius").number());
  else if (name == box) shape.size = json.member("half_extents").magnitudes();
  else if (name == capsule || name == cylinder) read_radii(json, shape);
}

std::string written(const std::vector<Vec3> &points)
{
  std::string text = "[";
  for (size_t i = 0; i < points.size(); ++i) text += (i ? ", " : "") + written(points[i]);
  return text + "]";
}

std::string written(const std::vector<Triangle> &triangles)
{
  std::string text = "[";
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto &[a, b, c] = triangles[i];
    text += fmt::format("{}[{}, {}, {}]", i ? ", " : "", a, b, c);
  }
  return text + "]";
}

template <class Field> void add_field(std::string &text, const char *key, const Field &value, const Field &otherwise)
{
  if (!same(value, otherwise)) text += fmt::format(", \"{}\": {}", key, written(value));
}

std::string written(const Child &child)
{
  const Child plain;
  std::string text = "{\"shape\": " + written_shape(child.shape);
  add_field(text, "position", child.position, plain.position);
  add_field(text, "orientation", child.orientation, plain.orientation);
  add_field(text, "density", child.density, plain.density);
  if (child.material) text += fmt::format(", \"material\": {}", *child.material);
  if (child.filter_group) text += fmt::format(", \"filter_group\": {}", *child.filter_group);
  if (child.filter_mask) text += fmt::format(", \"filter_mask\": {}", *child.filter_mask);
  return text + "}";
}

std::string written(const std::vector<Child> &children)
{
  std::string text = "[";
  for (size_t i = 0; i < children.size(); ++i) text += (i ? ",\n    " : "\n    ") + written(children[i]);
  return text + "]";
}

/* The "size" of a shape, or nothing if it is the expected one, which follows from the other keys. */
std::string written_size(const Shape &shape, const Vec3 &expected)
{
  return same(shape.size, expected) ? "" : ", \"size\": " + written(shape.size);
}

std::string written_radii(const Shape &shape)
{
  const auto &[bottom, half_height, top] = shape.size;
  const std::string radii =
      same(bottom, top) ? ", \"radius\": " + written(bottom)
                        : fmt::format(", \"radius_bottom\": {}, \"radius_top\": {}", written(bottom), written(top));
  return radii + ", \"half_height\": " + written(half_height);
}

} // namespace

Shape read_shape(const JsonValue &json, OutsideFiles outside)
{
  Shape shape;
  const auto name = Name(json.member("type").choice(names));
  std::vector<const char *> known = keys_of(name);
  std::optional<JsonValue> size = json.find("size");
  for (const char *key : replaced_by_size(name)) only_one(json, "size", key);
  known.insert(known.begin(), "type");
  json.only_keys(known);
  if (name == hull) shape = read_hull(json, outside);
  else if (name == mesh) shape = read_mesh(json, outside);
  else if (name == height_field) shape = read_height_field(json);
  else if (name == compound) shape = read_compound(json.member("children"), outside);
  else shape = {types[name], {0, 0, 0}};
  if (size) shape.size = size->magnitudes();
  else read_size(json, name, shape);
  return shape;
}

std::string written_shape(const Shape &shape)
{
  const size_t name = size_t(std::find(std::begin(types), std::end(types), shape.type) - std::begin(types));
  std::string text = fmt::format("{{\"type\": \"{}\"", names[name]);
  switch (shape.type) {
  case ShapeType::sphere: {
    const std::string size = written_size(shape, sphere_shape(shape.size[0]).size);
    return text + (size.empty() ? ", \"radius\": " + written(shape.size[0]) : size) + "}";
  }
  case ShapeType::box: return text + ", \"half_extents\": " + written(shape.size) + "}";
  case ShapeType::half_space: return text + written_size(shape, {0, 0, 0}) + "}";
  case ShapeType::hull:
    return text + ", \"points\": " + written(shape.hull->vertices) + written_size(shape, {0, 0, 0}) + "}";
  case ShapeType::mesh:
    return text + ", \"vertices\": " + written(shape.mesh->vertices) +
           ", \"triangles\": " + written(shape.mesh->triangles) + "}";
  case ShapeType::compound: return text + ", \"children\": " + written(shape.compound->children) + "}";
  case ShapeType::capsule:
  case ShapeType::cylinder: break;
  }
  return text + written_radii(shape) + "}";
}

} // namespace tandem
