/* scene_gltf_mesh.cpp - see scene_gltf_mesh.h; accessors after the glTF 2.0 specification, chapter 3.6. */
#include "host/scene_gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <set>

#include "host/scene_gltf_transform.h"

namespace tandem {
namespace {

/* Elements of an accessor within its buffer. */
struct Elements {
  const unsigned char *bytes = nullptr;
  size_t count = 0, stride = 0;

  template <class T> T at(size_t element, size_t component = 0) const
  {
    T value;
    std::memcpy(&value, bytes + element * stride + component * sizeof(T), sizeof(T));
    return value;
  }
};

bool is_index(int index, size_t size) { return index >= 0 && size_t(index) < size; }

[[noreturn]] void refuse_index(int64_t index, const char *what, size_t size, const JsonValue &asks)
{
  asks.fail(fmt::format("{} {} does not exist; the file has {}", what, index, size));
}
void require_int(uint32_t index, const char *what, size_t size, const JsonValue &asks)
{
  if (index > INT32_MAX) refuse_index(index, what, size, asks);
}

Elements elements_of(const tinygltf::Model &model, int index, const JsonValue &asks)
{
  if (!is_index(index, model.accessors.size()))
    asks.fail(fmt::format("accessor {} of the mesh does not exist; the file has {}", index, model.accessors.size()));
  const tinygltf::Accessor &accessor = model.accessors[size_t(index)];
  if (accessor.sparse.isSparse) asks.fail("a mesh of sparse accessors is not supported yet");
  if (!is_index(accessor.bufferView, model.bufferViews.size())) asks.fail(fmt::format("accessor {} of the mesh names no buffer view", index));
  const tinygltf::BufferView &view = model.bufferViews[size_t(accessor.bufferView)];
  if (!is_index(view.buffer, model.buffers.size())) asks.fail(fmt::format("buffer view {} of the mesh names no buffer", accessor.bufferView));
  const std::vector<unsigned char> &buffer = model.buffers[size_t(view.buffer)].data;
  const int stride = accessor.ByteStride(view), components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type)),
            component_bytes = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
  const size_t element = stride > 0 && components > 0 && component_bytes > 0 ? size_t(components) * size_t(component_bytes) : 0;
  const bool view_inside = view.byteOffset <= buffer.size() && view.byteLength <= buffer.size() - view.byteOffset;
  const size_t room = view_inside && accessor.byteOffset <= view.byteLength ? view.byteLength - accessor.byteOffset : 0;
  if (element == 0 || element > room || accessor.count == 0 || accessor.count - 1 > (room - element) / size_t(stride))
    asks.fail(fmt::format("accessor {} of the mesh, {} elements, lies outside its buffer", index, accessor.count));
  return {buffer.data() + view.byteOffset + accessor.byteOffset, accessor.count, size_t(stride)};
}

std::vector<uint32_t> indices_of(const tinygltf::Model &model, const tinygltf::Primitive &primitive, size_t vertices, const JsonValue &asks)
{
  std::vector<uint32_t> indices;
  if (primitive.indices < 0) {
    for (size_t i = 0; i < vertices; ++i) indices.push_back(uint32_t(i));
    return indices;
  }
  const Elements elements = elements_of(model, primitive.indices, asks);
  const int type = model.accessors[size_t(primitive.indices)].componentType;
  for (size_t i = 0; i < elements.count; ++i) {
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) indices.push_back(elements.at<uint8_t>(i));
    else if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) indices.push_back(elements.at<uint16_t>(i));
    else if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) indices.push_back(elements.at<uint32_t>(i));
    else asks.fail(fmt::format("indices of the mesh have the component type {}; 5121, 5123 and 5125 exist", type));
    if (indices.back() >= vertices) asks.fail(fmt::format("index {} of the mesh is out of range; it has {} vertices", indices.back(), vertices));
  }
  return indices;
}

/* Of the places 0 to count - 1: a list, a strip (every second one turned round) or a fan; none of points and lines. */
std::vector<Triangle> triangles_of(int mode, uint32_t count)
{
  std::vector<Triangle> triangles;
  const bool list = mode == TINYGLTF_MODE_TRIANGLES || mode == -1;
  for (uint32_t i = 0; i + 2 < count; i += list ? 3 : 1) {
    if (list) triangles.push_back({i, i + 1, i + 2});
    else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) triangles.push_back({i + 1, i + 2, 0});
  }
  return triangles;
}

/* Only vertices that the indices name belong to the mesh: primitives may share one accessor. */
void append_primitive(const tinygltf::Model &model, const tinygltf::Primitive &primitive, const Transform &place, const JsonValue &asks, GltfMesh &mesh)
{
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) return; /* nothing to see, says the specification */
  const Elements points = elements_of(model, position->second, asks);
  const tinygltf::Accessor &accessor = model.accessors[size_t(position->second)];
  if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    asks.fail("positions of the mesh that are not three floats each are not supported yet");
  const std::vector<uint32_t> indices = indices_of(model, primitive, points.count, asks);
  const auto base = uint32_t(mesh.vertices.size());
  for (uint32_t at : indices) {
    const Double3 point{points.at<float>(at, 0), points.at<float>(at, 1), points.at<float>(at, 2)};
    for (double x : point)
      if (!std::isfinite(x)) asks.fail(fmt::format("vertex {} of the mesh is [{}, {}, {}]; three finite numbers are needed", at, point[0], point[1], point[2]));
    mesh.vertices.push_back(transformed(place, point));
  }
  const bool mirrored = is_mirrored(place);
  for (const Triangle &t : triangles_of(primitive.mode, uint32_t(indices.size())))
    mesh.triangles.push_back({base + t[0], base + t[mirrored ? 2 : 1], base + t[mirrored ? 1 : 2]});
}

bool is_deformed(const std::vector<double> &morph_weights)
{
  return std::any_of(morph_weights.begin(), morph_weights.end(), [](double weight) { return weight != 0; });
}

void append_mesh(const GltfDocument &document, int index, const Transform &place, const JsonValue &asks, GltfMesh &mesh)
{
  const tinygltf::Model &model = document.model;
  if (!is_index(index, model.meshes.size())) refuse_index(index, "mesh", model.meshes.size(), asks);
  const tinygltf::Mesh &given = model.meshes[size_t(index)];
  if (is_deformed(given.weights)) asks.fail("a mesh deformed by morph targets is not supported yet");
  for (const tinygltf::Primitive &primitive : given.primitives) append_primitive(model, primitive, place, asks, mesh);
}

} // namespace

GltfMesh mesh_at(const GltfDocument &document, uint32_t index, const JsonValue &asks)
{
  GltfMesh mesh;
  require_int(index, "mesh", document.model.meshes.size(), asks);
  append_mesh(document, int(index), {}, asks, mesh);
  return mesh;
}

GltfMesh mesh_of_node(const GltfDocument &document, uint32_t root, const JsonValue &asks)
{
  GltfMesh mesh;
  std::set<int> visited;
  require_int(root, "node", document.model.nodes.size(), asks);
  std::vector<std::pair<int, Transform>> pending{{int(root), {}}};
  while (!pending.empty()) {
    const auto [index, place] = pending.back();
    pending.pop_back();
    document.require_node(index);
    if (!visited.insert(index).second) document.refuse(index, "has two parents; a node tree is needed");
    const tinygltf::Node &node = document.node(index);
    if (node.skin >= 0) asks.fail(fmt::format("the mesh of {}, deformed by a skin, is not supported yet", document.label(index)));
    if (is_deformed(node.weights))
      asks.fail(fmt::format("the mesh of {}, deformed by morph targets, is not supported yet", document.label(index)));
    if (node.mesh >= 0) append_mesh(document, node.mesh, place, asks, mesh);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      document.require_node(*child);
      pending.push_back({*child, place * local_transform(document, *child)});
    }
  }
  return mesh;
}

} // namespace tandem
