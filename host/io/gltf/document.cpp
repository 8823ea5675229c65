/* document.cpp - reads files, nodes and scenes; see document.h. It follows the glTF 2.0 specification,
 * chapters 3.5 (nodes) and 4 (binary files). */
#include "host/io/gltf/document.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include <fmt/format.h>

#include "host/base/printable.h"
#include "host/io/gltf/animation.h"
#include "host/io/gltf/extensions.h"

namespace tandem {
namespace {

constexpr uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

uint32_t number_at(const std::string &bytes, size_t at)
{
  uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/* The chunks of a binary file, each with length, type and bytes. The first is the JSON, the optional second one the
 * buffer. */
struct Chunks {
  std::string json, binary;
};

/* Chunks are padded to four bytes. The JSON chunk must be padded with blanks, but some writers use zeros, as for the
 * other chunk. */
std::string without_padding(std::string json)
{
  for (int i = 0; i < 3 && json.ends_with('\0'); ++i) json.pop_back();
  return json;
}

Chunks chunks_of(const std::string &bytes, const std::string &where)
{
  const auto fail = [&](const char *why) {
    throw InputError(fmt::format("{}: no readable binary glTF file: {}", where, why));
  };
  if (bytes.size() < 20) fail("it ends within its first 20 bytes");
  if (number_at(bytes, 4) != 2) fail("it is not of version 2");
  const size_t end = number_at(bytes, 8);
  if (end > bytes.size()) fail("it is shorter than it says");
  Chunks chunks;
  size_t number = 0;
  for (size_t at = 12; at < end; ++number) {
    const size_t remaining = end - at;
    if (remaining < 8 || number_at(bytes, at) > remaining - 8) fail("a chunk ends behind the file");
    const uint32_t length = number_at(bytes, at), type = number_at(bytes, at + 4);
    if ((number == 0) != (type == json_chunk)) fail("its first chunk, and that one alone, must be the JSON");
    if (number == 0) chunks.json = without_padding(bytes.substr(at + 8, length));
    else if (number == 1 && type == binary_chunk) chunks.binary = bytes.substr(at + 8, length);
    at += 8 + size_t{length};
  }
  return chunks;
}

/* The minor version, which is 1 for "2.1". */
uint32_t minor_version(const JsonValue &json)
{
  const std::string text = json.text();
  uint32_t minor = 0;
  const char *begin = text.data() + 2, *end = text.data() + text.size();
  const bool major = text.starts_with("2.") && text.size() > 2;
  const auto [stop, error] =
      major ? std::from_chars(begin, end, minor) : std::from_chars_result{begin, std::errc::invalid_argument};
  if (error != std::errc{} || stop != end) json.fail(fmt::format("is {}; glTF 2 is read", nlohmann::json(text).dump()));
  return minor;
}

void check_version(const JsonValue &root)
{
  const JsonValue asset = root.member("asset"), version = asset.member("version");
  minor_version(version); /* additions of a later version may be ignored, unless the file forbids it */
  if (const auto least = asset.find("minVersion"); least && minor_version(*least) > 0)
    least->fail(
        fmt::format("is {}; glTF 2.0 is read, and a reader of 2.0 must refuse what asks for more", least->text()));
}

std::vector<double> read_numbers(const JsonValue &list)
{
  std::vector<double> numbers;
  for (size_t i = 0; i < list.array_size(); ++i) numbers.push_back(list.element(i).precise_number());
  return numbers;
}

std::vector<int> read_indices(const JsonValue &list, const char *what, size_t count)
{
  std::vector<int> indices;
  for (size_t i = 0; i < list.array_size(); ++i) indices.push_back(gltf_index(list.element(i), what, count));
  return indices;
}

const char *const node_keys[] = {"camera", "children",    "skin",    "matrix", "mesh",   "rotation",
                                 "scale",  "translation", "weights", "name",   "extras", "extensions"};

/* A matrix replaces translation, rotation and scale. */
void check_transform(const JsonValue &json, const GltfNode &node)
{
  for (const auto &[key, size] : {std::pair{"matrix", 16}, {"translation", 3}, {"rotation", 4}, {"scale", 3}})
    if (const auto list = json.find(key); list && list->array_size() != size_t(size))
      list->fail(fmt::format("has {} numbers; {} are needed", list->array_size(), size));
  for (const char *key : {"translation", "rotation", "scale"})
    if (json.find("matrix") && json.find(key)) json.fail(fmt::format("matrix and {} exclude each other", key));
  const std::vector<double> &m = node.matrix;
  if (!m.empty() && (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1))
    json.member("matrix").fail("the last row of the matrix (numbers 3, 7, 11 and 15) must be 0, 0, 0, 1");
}

void read_node(const JsonValue &json, size_t node_count, size_t mesh_count, GltfNode &node)
{
  json.only_keys(node_keys);
  if (const auto list = json.find("children")) node.children = read_indices(*list, "node", node_count);
  if (const auto mesh = json.find("mesh")) node.mesh = gltf_index(*mesh, "mesh", mesh_count);
  for (const auto &[key, numbers] : {std::pair{"matrix", &node.matrix},
                                     {"translation", &node.translation},
                                     {"rotation", &node.rotation},
                                     {"scale", &node.scale},
                                     {"weights", &node.weights}})
    if (const auto list = json.find(key)) *numbers = read_numbers(*list);
  check_transform(json, node);
  node.has_skin = json.find("skin").has_value();
  node.has_instances = gltf_extension_of(json, "EXT_mesh_gpu_instancing").has_value();
}

size_t count_of(const JsonValue &root, const char *list)
{
  const std::optional<JsonValue> found = root.find(list);
  return found ? found->array_size() : 0;
}

/* Every error message about a node begins with its name. */
void read_nodes(GltfDocument &document)
{
  const JsonValue root = document.root();
  document.nodes.resize(count_of(root, "nodes"));
  for (size_t i = 0; i < document.nodes.size(); ++i) {
    GltfNode &node = document.nodes[i];
    const JsonValue unnamed = root.member("nodes").element(i);
    if (const auto name = unnamed.find("name")) node.name = name->text();
    node.place = fmt::format("{}: {}", document.where, document.label(int(i)));
    const nlohmann::json &value = document.file.value()["nodes"][i];
    const JsonValue json(value, node.place, "", JsonFloats::numbers);
    read_node(json, document.nodes.size(), count_of(root, "meshes"), node);
    if (gltf_extension_of(json, bodies_extension)) node.physics = &value["extensions"][bodies_extension];
  }
}

std::vector<int> nodes_without_parents(const GltfDocument &document)
{
  std::vector<bool> is_child(document.nodes.size());
  for (const GltfNode &node : document.nodes)
    for (int child : node.children) is_child[size_t(child)] = true;
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(int(i));
  return roots;
}

void read_scenes(GltfDocument &document)
{
  static constexpr const char *keys[] = {"nodes", "name", "extras", "extensions"};
  const JsonValue root = document.root();
  const size_t scenes = count_of(root, "scenes");
  const std::optional<JsonValue> given = root.find("scene");
  const size_t chosen = given ? size_t(gltf_index(*given, "scene", scenes)) : 0;
  if (scenes == 0) document.roots = nodes_without_parents(document);
  for (size_t i = 0; i < scenes; ++i) {
    const JsonValue scene = root.member("scenes").element(i);
    scene.only_keys(keys);
    const std::optional<JsonValue> list = scene.find("nodes");
    const std::vector<int> nodes = list ? read_indices(*list, "node", document.nodes.size()) : std::vector<int>{};
    if (i == chosen) document.roots = nodes;
  }
}

} // namespace

std::string GltfDocument::label(int index) const
{
  const std::string &name = node(index).name;
  return name.empty() ? fmt::format("node {}", index) : fmt::format("node '{}'", printable(name));
}

void GltfDocument::refuse(int index, const std::string &what) const
{
  throw InputError(fmt::format("{}: {}", place(index), what));
}

std::optional<JsonValue> GltfDocument::physics_of(int index) const
{
  if (!node(index).physics) return {};
  return JsonValue(*node(index).physics, place(index), "", JsonFloats::numbers);
}

JsonValue GltfDocument::extension(const char *name, const std::string &place) const
{
  static const nlohmann::json none = nlohmann::json::object();
  const bool given = gltf_extension_of(root(), name).has_value();
  return {given ? file.value().at("extensions").at(name) : none, place, std::string("extensions.") + name,
          JsonFloats::numbers};
}

bool GltfDocument::uses(const std::string &extension) const
{
  for (const char *list : {"extensionsUsed", "extensionsRequired"})
    if (const auto names = root().find(list))
      for (size_t i = 0; i < names->array_size(); ++i)
        if (names->element(i).text() == extension) return true;
  return false;
}

std::optional<JsonValue> gltf_extension_of(const JsonValue &owner, const char *name)
{
  const std::optional<JsonValue> extensions = owner.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

int gltf_index(const JsonValue &json, const char *what, size_t count)
{
  const uint32_t index = json.unsigned_integer();
  if (index >= count || index > INT32_MAX)
    json.fail(fmt::format("{} {} does not exist; the file has {}", what, index, count));
  return int(index);
}

GltfDocument read_gltf_document(const std::string &path, OutsideFiles outside)
{
  GltfDocument document;
  document.where = path;
  document.outside = outside;
  std::string text = read_file(path);
  if (text.starts_with("glTF")) {
    Chunks chunks = chunks_of(text, path);
    text = std::move(chunks.json);
    document.binary = std::move(chunks.binary);
  }
  document.file = parse_json(text, path);
  check_version(document.root());
  check_required_extensions(document.root());
  read_nodes(document);
  read_scenes(document);
  read_gltf_animations(document);
  return document;
}

} // namespace tandem
