/* shapes.cpp - reads implicit shapes and meshes, and finds meshes that are convex; see shapes.h. */
#include "host/io/gltf/shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/mass_properties.h"
#include "host/io/gltf/mesh.h"
#include "host/io/gltf/round.h"

namespace tandem {
namespace {

/* Relative to the hull's volume: a mesh that lacks at most this much, by the rounding of its vertices, is the same
 * solid. */
constexpr double same_volume = 1e-4;

bool even(float a, float b) { return std::max(a, b) <= std::min(a, b) * 1.0001f; }
bool even(const Vec3 &scale)
{
  return even(scale[0], scale[1]) && even(scale[1], scale[2]) && even(scale[0], scale[2]);
}

float number_or(const JsonValue &json, const char *key, float otherwise)
{
  std::optional<JsonValue> found = json.find(key);
  return found ? found->number() : otherwise;
}

/* The triangles are counter-clockwise seen from above, and also seen from below if it is double-sided. */
Shape rectangle(float size_x, float size_z, bool double_sided, const std::string &where)
{
  const float x = 0.5f * size_x, z = 0.5f * size_z;
  const std::vector<Vec3> corners{{-x, 0, -z}, {-x, 0, z}, {x, 0, z}, {x, 0, -z}};
  std::vector<uint32_t> indices{0, 1, 2, 0, 2, 3};
  if (double_sided) indices.insert(indices.end(), {0, 2, 1, 0, 3, 2});
  return mesh_shape(corners, indices, where);
}

Shape read_plane(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"doubleSided", "sizeX", "sizeZ", "extras", "extensions"};
  json.only_keys(keys);
  const std::optional<JsonValue> size_x = json.find("sizeX"), size_z = json.find("sizeZ"),
                                 sides = json.find("doubleSided");
  const bool double_sided = sides && sides->boolean();
  if (size_x.has_value() != size_z.has_value())
    json.fail("a plane finite along one axis alone is not supported yet; sizeX and sizeZ together are");
  if (!size_x && double_sided)
    json.fail("an infinite double-sided plane is not supported yet; with sizeX and sizeZ it is");
  if (!size_x) return half_space_shape();
  for (const JsonValue &size : {*size_x, *size_z})
    if (!(size.number() > 0)) size.fail(fmt::format("is {}; a number above 0 is needed", size.number()));
  return rectangle(size_x->number() * scale[0], size_z->number() * scale[2], double_sided, json.place());
}

Shape read_sphere(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"radius", "extras", "extensions"};
  json.only_keys(keys);
  const float radius = number_or(json, "radius", 0.5f);
  if (even(scale)) return sphere_shape(radius * scale[0]);
  return round_hull(ShapeType::sphere, {radius, radius, radius}, scale, json.place());
}

Shape read_box(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"size", "extras", "extensions"};
  json.only_keys(keys);
  std::optional<JsonValue> size = json.find("size");
  Vec3 edges = size ? size->magnitudes() : Vec3{1, 1, 1};
  return box_shape(0.5f * edges[0] * scale[0], 0.5f * edges[1] * scale[1], 0.5f * edges[2] * scale[2]);
}

/* Radius of the bottom, half the height, radius of the top of the extension's two shapes along Y. */
Vec3 read_round(const JsonValue &json, const Vec3 &scale)
{
  static constexpr const char *keys[] = {"height", "radiusBottom", "radiusTop", "extras", "extensions"};
  json.only_keys(keys);
  return {number_or(json, "radiusBottom", 0.25f) * scale[0], 0.5f * number_or(json, "height", 0.5f) * scale[1],
          number_or(json, "radiusTop", 0.25f) * scale[0]};
}

Shape read_cylinder(const JsonValue &json, const Vec3 &scale)
{
  if (even(scale[0], scale[2])) return {ShapeType::cylinder, read_round(json, scale)};
  return round_hull(ShapeType::cylinder, read_round(json, {1, 1, 1}), scale, json.place());
}

/* If one sphere contains the other, the hull of both is the larger sphere; `offset` is then its height. */
Shape read_capsule(const JsonValue &json, const Vec3 &scale, double &offset)
{
  const Vec3 own = read_round(json, {1, 1, 1}), size = read_round(json, scale);
  const auto &[bottom, half_height, top] = own;
  if (std::min(bottom, top) < 0 || std::max(bottom, top) == 0 || !(half_height > 0))
    json.fail(fmt::format("a capsule of radii {} and {} and of height {}; a height above 0 and radii of at least 0, "
                          "one above it, are needed",
                          bottom, top, 2 * half_height));
  const bool sphere = std::abs(double(bottom) - top) >= 2.0 * half_height;
  if (sphere && even(scale)) {
    offset = bottom > top ? -double(size[1]) : double(size[1]);
    return sphere_shape(std::max(size[0], size[2]));
  }
  if (even(scale) && std::min(bottom, top) > 0) return {ShapeType::capsule, size};
  return round_hull(ShapeType::capsule, own, scale, json.place());
}

bool is_closed_without_dents(const TriangleMesh &mesh)
{
  const MeshFindings &found = mesh.findings;
  if (mesh.flat || found.boundary_edges + found.non_manifold_edges + found.misoriented_edges > 0) return false;
  return std::none_of(mesh.edges.begin(), mesh.edges.end(),
                      [](const MeshEdge &edge) { return edge.kind == EdgeKind::concave; });
}

bool is_surface_of(const ConvexHull &hull, const TriangleMesh &mesh)
{
  const double volume = polyhedron_mass(mesh.vertices, mesh.triangles).mass, whole = hull_mass(hull).mass;
  return std::abs(volume - whole) <= same_volume * whole;
}

std::vector<Vec3> scaled_vertices(const GltfMesh &mesh, const std::array<double, 3> &scale)
{
  std::vector<Vec3> vertices;
  for (const Double3 &v : mesh.vertices)
    vertices.push_back(
        {round_to_float(v[0] * scale[0]), round_to_float(v[1] * scale[1]), round_to_float(v[2] * scale[2])});
  return vertices;
}

Shape solid_of(const GltfMesh &mesh, const std::array<double, 3> &scale, bool hull_asked, const JsonValue &geometry)
{
  const std::string where = geometry.place();
  if (mesh.vertices.empty()) geometry.fail("a mesh without vertices; a collider needs a shape");
  const std::vector<Vec3> vertices = scaled_vertices(mesh, scale);
  if (hull_asked) return hull_shape(vertices, where);
  if (mesh.triangles.empty())
    geometry.fail("a mesh without triangles; \"convexHull\": true asks for the hull of its points");
  const std::vector<Triangle> triangles = scale[0] < 0 ? turned_round(mesh.triangles) : mesh.triangles;
  auto surface = std::make_shared<const TriangleMesh>(triangle_mesh(vertices, triangles, where));
  if (is_closed_without_dents(*surface)) {
    Shape hull = hull_shape(surface->vertices, where);
    if (is_surface_of(*hull.hull, *surface)) return hull;
  }
  return {ShapeType::mesh, {0, 0, 0}, nullptr, std::move(surface)};
}

} // namespace

GltfShape GltfShapes::read_implicit(const JsonValue &geometry, uint32_t index, const Vec3 &scale) const
{
  static constexpr const char *document_keys[] = {"shapes", "extras", "extensions"};
  const nlohmann::json empty = nlohmann::json::object();
  const JsonValue document = document_.extension(shapes_extension, geometry.where());
  document.only_keys(document_keys);
  JsonValue list = document.member("shapes");
  if (index >= list.array_size())
    geometry.member("shape").fail(fmt::format("shape {} does not exist; the file has {}", index, list.array_size()));
  JsonValue json = list.element(index);
  std::string type = json.member("type").text();
  GltfShape result;
  if (type == "plane")
    result.shape = read_plane(json.find("plane").value_or(JsonValue(empty, geometry.where())), scale);
  else if (type == "sphere") result.shape = read_sphere(json.member("sphere"), scale);
  else if (type == "box") result.shape = read_box(json.member("box"), scale);
  else if (type == "cylinder") result.shape = read_cylinder(json.member("cylinder"), scale);
  else if (type == "capsule") result.shape = read_capsule(json.member("capsule"), scale, result.offset);
  else
    geometry.fail(
        fmt::format("shape type {} is not supported yet; sphere, box, capsule, cylinder and plane are", type));
  return result;
}

GltfShape GltfShapes::read(const JsonValue &geometry, const std::array<double, 3> &scale)
{
  static constexpr const char *keys[] = {"shape", "node", "mesh", "convexHull", "extras", "extensions"},
                              *sources[] = {"shape", "node", "mesh"};
  geometry.only_keys(keys);
  Use use{0, false, 0, scale};
  int given = 0;
  for (int source = 0; source < 3; ++source)
    if (const std::optional<JsonValue> index = geometry.find(sources[source])) {
      use.source = source;
      use.index = index->unsigned_integer();
      ++given;
    }
  if (given != 1) geometry.fail(fmt::format("names {} of shape, node and mesh; exactly one is needed", given));
  if (const std::optional<JsonValue> hull = geometry.find("convexHull")) use.hull_asked = hull->boolean();
  const auto found = known_.find(use);
  if (found != known_.end()) return found->second;
  GltfShape result;
  if (use.source == 0)
    result = read_implicit(geometry, use.index,
                           {round_to_float(std::abs(scale[0])), round_to_float(scale[1]), round_to_float(scale[2])});
  else
    result.shape =
        solid_of(use.source == 1 ? meshes_.of_node(use.index, geometry) : meshes_.of_mesh(use.index, geometry), scale,
                 use.hull_asked, geometry);
  return known_.emplace(use, std::move(result)).first->second;
}

} // namespace tandem
