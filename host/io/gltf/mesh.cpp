/* mesh.cpp - assembles meshes from primitives; see mesh.h. Accessors follow the glTF 2.0 specification, chapter 3.6. */
#include "host/io/gltf/mesh.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "host/io/gltf/transform.h"

namespace tandem {
namespace {

std::vector<uint32_t> indices_of(const GltfElements &elements, size_t vertices, const JsonValue &asks)
{
  const int type = elements.accessor.componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    asks.fail(fmt::format("indices of the mesh have the component type {}; 5121, 5123 and 5125 exist", type));
  if (elements.accessor.type != TINYGLTF_TYPE_SCALAR) asks.fail("indices of the mesh must be scalars");
  if (elements.accessor.normalized) asks.fail("indices of the mesh must not be normalized");
  std::vector<uint32_t> indices;
  for (size_t i = 0; i < elements.count; ++i) {
    indices.push_back(uint32_t(elements.at(i)));
    if (indices.back() >= vertices)
      asks.fail(fmt::format("index {} of the mesh is out of range; it has {} vertices", indices.back(), vertices));
  }
  return indices;
}

std::vector<uint32_t> all_of(size_t vertices)
{
  std::vector<uint32_t> indices(vertices);
  for (size_t i = 0; i < vertices; ++i) indices[i] = uint32_t(i);
  return indices;
}

/* Throws if the vertices 0 to count - 1 do not make whole triangles. */
void check_count(uint32_t mode, size_t count, const JsonValue &asks)
{
  if (mode < TINYGLTF_MODE_TRIANGLES) return;
  if (mode == TINYGLTF_MODE_TRIANGLES && count % 3 != 0)
    asks.fail(fmt::format("the mesh lists {} corners of triangles; a multiple of 3 is needed", count));
  if (count < 3) asks.fail(fmt::format("a strip or fan of the mesh has {} corners; at least 3 are needed", count));
}

/* The triangles of the vertices 0 to count - 1: a list, a strip (every second triangle reversed) or a fan; none for
 * points and lines. */
std::vector<Triangle> triangles_of(uint32_t mode, uint32_t count)
{
  std::vector<Triangle> triangles;
  const bool list = mode == TINYGLTF_MODE_TRIANGLES;
  for (uint32_t i = 0; i + 2 < count; i += list ? 3 : 1) {
    if (list) triangles.push_back({i, i + 1, i + 2});
    else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) triangles.push_back({i + 1, i + 2, 0});
  }
  return triangles;
}

/* Positions are three floats each, or the integers of KHR_mesh_quantization, which the node's scale converts to
 * metres. */
void check_positions(const GltfElements &points, const GltfDocument &document, const JsonValue &asks)
{
  const int type = points.accessor.componentType;
  const bool quantized = type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                         document.uses("KHR_mesh_quantization");
  if (points.accessor.type != TINYGLTF_TYPE_VEC3 || (type != TINYGLTF_COMPONENT_TYPE_FLOAT && !quantized))
    asks.fail("positions of the mesh that are not three floats each are not supported yet, but for the whole numbers "
              "of KHR_mesh_quantization");
  if (type == TINYGLTF_COMPONENT_TYPE_FLOAT && points.accessor.normalized)
    asks.fail("positions of the mesh are floats; only whole numbers can be normalized");
}

/* Only vertices that the indices name belong to the mesh, because primitives may share one accessor. */
void append_vertices(const GltfElements &points, const std::vector<uint32_t> &indices, const Transform &place,
                     const JsonValue &asks, GltfMesh &mesh)
{
  for (uint32_t at : indices) {
    const Double3 point{points.at(at, 0), points.at(at, 1), points.at(at, 2)};
    for (double x : point)
      if (!std::isfinite(x))
        asks.fail(fmt::format("vertex {} of the mesh is [{}, {}, {}]; three finite numbers are needed", at, point[0],
                              point[1], point[2]));
    mesh.vertices.push_back(transformed(place, point));
  }
}

uint32_t mode_of(const JsonValue &primitive)
{
  const std::optional<JsonValue> mode = primitive.find("mode");
  if (!mode) return TINYGLTF_MODE_TRIANGLES;
  if (mode->unsigned_integer() > TINYGLTF_MODE_TRIANGLE_FAN)
    mode->fail(fmt::format("is {}; 0 (points) to 6 (a fan of triangles) exist", mode->unsigned_integer()));
  return mode->unsigned_integer();
}

bool is_deformed(const std::vector<double> &morph_weights)
{
  return std::any_of(morph_weights.begin(), morph_weights.end(), [](double weight) { return weight != 0; });
}

bool is_deformed(const JsonValue &mesh)
{
  const std::optional<JsonValue> weights = mesh.find("weights");
  for (size_t i = 0; weights && i < weights->array_size(); ++i)
    if (weights->element(i).precise_number() != 0) return true;
  return false;
}

} // namespace

/* A compressed primitive may also contain the uncompressed data, for readers that do not support the compression. */
void GltfMeshes::check_packing(const JsonValue &primitive, uint32_t accessor, const JsonValue &asks) const
{
  if (!gltf_extension_of(primitive, "KHR_draco_mesh_compression")) return;
  const std::optional<JsonValue> accessors = document_.root().find("accessors");
  if (accessors && accessor < accessors->array_size() && !accessors->element(accessor).find("bufferView"))
    asks.fail("a mesh packed by KHR_draco_mesh_compression is not supported yet");
}

void GltfMeshes::append_primitive(const JsonValue &primitive, const Transform &place, const JsonValue &asks,
                                  GltfMesh &mesh)
{
  static constexpr const char *keys[] = {"attributes", "indices", "material",  "mode",
                                         "targets",    "extras",  "extensions"};
  primitive.only_keys(keys);
  const std::optional<JsonValue> position = primitive.member("attributes").find("POSITION"),
                                 chosen = primitive.find("indices");
  if (!position) return; /* the specification says that nothing is rendered */
  for (const std::optional<JsonValue> &accessor : {position, chosen})
    if (accessor) check_packing(primitive, accessor->unsigned_integer(), asks);
  const GltfElements points = buffers_.elements_of(position->unsigned_integer(), asks);
  check_positions(points, document_, asks);
  const std::vector<uint32_t> indices =
      chosen ? indices_of(buffers_.elements_of(chosen->unsigned_integer(), asks), points.count, asks)
             : all_of(points.count);
  const auto base = uint32_t(mesh.vertices.size());
  append_vertices(points, indices, place, asks, mesh);
  const bool mirrored = is_mirrored(place);
  const uint32_t mode = mode_of(primitive);
  check_count(mode, indices.size(), asks);
  for (const Triangle &t : triangles_of(mode, uint32_t(indices.size())))
    mesh.triangles.push_back({base + t[0], base + t[mirrored ? 2 : 1], base + t[mirrored ? 1 : 2]});
}

void GltfMeshes::append_mesh(int index, const Transform &place, const JsonValue &asks, GltfMesh &mesh)
{
  static constexpr const char *keys[] = {"primitives", "weights", "name", "extras", "extensions"};
  const std::string where = asks.place();
  const JsonValue given = gltf_item(document_, "meshes", size_t(index), where);
  given.only_keys(keys);
  if (is_deformed(given)) asks.fail("a mesh deformed by morph targets is not supported yet");
  const JsonValue primitives = given.member("primitives");
  for (size_t i = 0; i < primitives.array_size(); ++i) append_primitive(primitives.element(i), place, asks, mesh);
}

GltfMesh GltfMeshes::of_mesh(uint32_t index, const JsonValue &asks)
{
  GltfMesh mesh;
  const std::optional<JsonValue> meshes = document_.root().find("meshes");
  const size_t count = meshes ? meshes->array_size() : 0;
  if (index >= count) asks.fail(fmt::format("mesh {} does not exist; the file has {}", index, count));
  append_mesh(int(index), {}, asks, mesh);
  return mesh;
}

GltfMesh GltfMeshes::of_node(uint32_t root, const JsonValue &asks)
{
  GltfMesh mesh;
  std::set<int> visited;
  if (root >= document_.nodes.size())
    asks.fail(fmt::format("node {} does not exist; the file has {}", root, document_.nodes.size()));
  std::vector<std::pair<int, Transform>> pending{{int(root), {}}};
  while (!pending.empty()) {
    const auto [index, place] = pending.back();
    pending.pop_back();
    if (!visited.insert(index).second) document_.refuse(index, "has two parents; a node tree is needed");
    const GltfNode &node = document_.node(index);
    if (node.has_skin)
      asks.fail(fmt::format("the mesh of {}, deformed by a skin, is not supported yet", document_.label(index)));
    if (node.has_instances)
      asks.fail(fmt::format("the mesh of {}, many times over by EXT_mesh_gpu_instancing, is not supported yet",
                            document_.label(index)));
    if (is_deformed(node.weights))
      asks.fail(fmt::format("the mesh of {}, deformed by morph targets, is not supported yet", document_.label(index)));
    if (node.mesh) append_mesh(*node.mesh, place, asks, mesh);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      pending.push_back({*child, place * local_transform(document_, *child)});
  }
  return mesh;
}

} // namespace tandem
