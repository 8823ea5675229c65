/* scene_gltf_shapes.cpp - see scene_gltf_shapes.h. */
#include "host/scene_gltf_shapes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "host/geometry/mass_properties.h"
#include "host/scene_gltf_mesh.h"

namespace tandem {
namespace {

/* Of the hull's volume: what a mesh may lack of it by the roundings of its vertices, and still be the same solid. */
constexpr double same_volume = 1e-4;

bool even(float a, float b) { return std::max(a, b) <= std::min(a, b) * 1.0001f; }

float number_or(const JsonValue &json, const char *key, float otherwise)
{
  std::optional<JsonValue> found = json.find(key);
  return found ? found->number() : otherwise;
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

void require_even(const JsonValue &json, const char *shape, const Vec3 &scale)
{
  if (!even(scale[0], scale[1]) || !even(scale[1], scale[2]) || !even(scale[0], scale[2]))
    json.fail(fmt::format("a {} scaled unevenly ({}, {}, {}) is not supported yet", shape, scale[0], scale[1], scale[2]));
}

Shape read_sphere(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"radius", "extras", "extensions"};
  json.only_keys(keys);
  require_even(json, "sphere", scale);
  return sphere_shape(number_or(json, "radius", 0.5f) * scale[0]);
}

Shape read_box(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"size", "extras", "extensions"};
  json.only_keys(keys);
  std::optional<JsonValue> size = json.find("size");
  Vec3 edges = size ? size->vec3() : Vec3{1, 1, 1};
  return box_shape(0.5f * edges[0] * scale[0], 0.5f * edges[1] * scale[1], 0.5f * edges[2] * scale[2]);
}

/* Radius below, half the height, radius above: of the extension's two shapes along Y. */
Vec3 read_round(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"height", "radiusBottom", "radiusTop", "extras", "extensions"};
  json.only_keys(keys);
  return {number_or(json, "radiusBottom", 0.25f) * scale[0], 0.5f * number_or(json, "height", 0.5f) * scale[1],
          number_or(json, "radiusTop", 0.25f) * scale[0]};
}

Shape read_cylinder(const JsonValue &json, const Vec3 &scale)
{
  if (!even(scale[0], scale[2]))
    json.fail(fmt::format("a cylinder scaled unevenly across its axis ({}, {}) is not supported yet", scale[0], scale[2]));
  return {ShapeType::cylinder, read_round(json, scale)};
}

/* Where one sphere holds the other, the hull of both is the larger: `offset` then is its height. */
Shape read_capsule(const JsonValue &json, const Vec3 &scale, double &offset)
{
  require_even(json, "capsule", scale);
  const Vec3 size = read_round(json, scale);
  const float bottom = size[0], half_height = size[1], top = size[2];
  if (half_height > 0 && std::min(bottom, top) >= 0 && std::abs(double(bottom) - top) >= 2.0 * half_height) {
    offset = bottom > top ? -double(half_height) : double(half_height);
    return sphere_shape(std::max(bottom, top));
  }
  if (bottom == 0 || top == 0) json.fail("a capsule with a radius of 0 is not supported yet; a sphere or a cylinder is");
  return {ShapeType::capsule, size};
}

bool is_surface_of(const ConvexHull &hull, const TriangleMesh &mesh)
{
  const MeshFindings &found = mesh.findings;
  if (found.boundary_edges + found.non_manifold_edges + found.misoriented_edges > 0) return false;
  if (std::any_of(mesh.edges.begin(), mesh.edges.end(), [](const MeshEdge &edge) { return edge.kind == EdgeKind::concave; })) return false;
  const double volume = polyhedron_mass(mesh.vertices, mesh.triangles).mass, whole = hull_mass(hull).mass;
  return std::abs(volume - whole) <= same_volume * whole;
}

std::vector<Vec3> scaled_vertices(const GltfMesh &mesh, const std::array<double, 3> &scale)
{
  std::vector<Vec3> vertices;
  for (const Double3 &v : mesh.vertices) vertices.push_back({float(v[0] * scale[0]), float(v[1] * scale[1]), float(v[2] * scale[2])});
  return vertices;
}

Shape convex_shape(const GltfMesh &mesh, const std::array<double, 3> &scale, bool hull_asked, const JsonValue &geometry)
{
  const std::string where = geometry.place();
  if (mesh.vertices.empty()) geometry.fail("a mesh without vertices; a collider needs a shape");
  const std::vector<Vec3> vertices = scaled_vertices(mesh, scale);
  constexpr const char *refusal = "a triangle mesh that is not closed and convex is not supported yet; \"convexHull\": true asks for its hull";
  if (hull_asked) return hull_shape(vertices, where);
  if (mesh.has_other_primitives || mesh.triangles.empty()) geometry.fail(refusal);
  const std::vector<Triangle> triangles = scale[0] < 0 ? turned_round(mesh.triangles) : mesh.triangles;
  const TriangleMesh surface = triangle_mesh(vertices, triangles, where);
  if (surface.flat) geometry.fail(refusal);
  Shape shape = hull_shape(vertices, where);
  if (!is_surface_of(*shape.hull, surface)) geometry.fail(refusal);
  return shape;
}

} // namespace

uint32_t GltfShapes::add(const Shape &shape)
{
  shapes_.push_back(shape);
  return uint32_t(shapes_.size() - 1);
}

GltfShape GltfShapes::read_implicit(const JsonValue &geometry, const Vec3 &scale)
{
  static constexpr const char *document_keys[] = {"shapes", "extras", "extensions"};
  JsonValue chosen = geometry.member("shape"), document(document_.shapes, geometry.where(), std::string("extensions.") + shapes_extension);
  document.only_keys(document_keys);
  JsonValue list = document.member("shapes");
  uint32_t index = chosen.unsigned_integer();
  if (index >= list.array_size()) chosen.fail(fmt::format("shape {} does not exist; the file has {}", index, list.array_size()));
  JsonValue json = list.element(index);
  std::string type = json.member("type").text();
  nlohmann::json empty = nlohmann::json::object();
  Shape shape;
  GltfShape result;
  if (type == "plane") shape = read_plane(json.find("plane").value_or(JsonValue(empty, geometry.where())));
  else if (type == "sphere") shape = read_sphere(json.member("sphere"), scale);
  else if (type == "box") shape = read_box(json.member("box"), scale);
  else if (type == "cylinder") shape = read_cylinder(json.member("cylinder"), scale);
  else if (type == "capsule") shape = read_capsule(json.member("capsule"), scale, result.offset);
  else geometry.fail(fmt::format("shape type {} is not supported yet; sphere, box, capsule, cylinder and plane are", type));
  auto [at, added] = implicit_.emplace(std::pair{uint32_t(shape.type), shape.size}, uint32_t(shapes_.size()));
  if (added) add(shape);
  result.index = at->second;
  return result;
}

uint32_t GltfShapes::read_mesh(const JsonValue &geometry, const std::array<double, 3> &scale)
{
  std::optional<JsonValue> node = geometry.find("node"), hull = geometry.find("convexHull");
  const MeshUse use{node.has_value(), hull && hull->boolean(), (node ? *node : geometry.member("mesh")).unsigned_integer(), scale};
  auto [at, added] = meshes_.emplace(use, uint32_t(shapes_.size()));
  if (!added) return at->second;
  return add(convex_shape(use.is_node ? mesh_of_node(document_, use.index, geometry) : mesh_at(document_, use.index, geometry), scale, use.hull_asked,
                          geometry));
}

GltfShape GltfShapes::read(const JsonValue &geometry, const std::array<double, 3> &scale)
{
  static constexpr const char *keys[] = {"shape", "node", "mesh", "convexHull", "extras", "extensions"};
  geometry.only_keys(keys);
  const int given = int(geometry.find("shape").has_value()) + int(geometry.find("node").has_value()) + int(geometry.find("mesh").has_value());
  if (given != 1) geometry.fail(fmt::format("names {} of shape, node and mesh; exactly one is needed", given));
  if (!geometry.find("shape")) return {read_mesh(geometry, scale), 0};
  return read_implicit(geometry, {float(std::abs(scale[0])), float(scale[1]), float(scale[2])});
}

} // namespace tandem
