/* buffers.cpp - reads accessors, views and buffers; see buffers.h. It follows the glTF 2.0 specification, chapter
 * 3.6. */
#include "host/io/gltf/buffers.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace tandem {
namespace {

constexpr const char *packed_views[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

template <class T> double number_of(const char *bytes)
{
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return double(value);
}

double number_of(int component_type, const char *bytes)
{
  switch (component_type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: return number_of<int8_t>(bytes);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return number_of<uint8_t>(bytes);
  case TINYGLTF_COMPONENT_TYPE_SHORT: return number_of<int16_t>(bytes);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return number_of<uint16_t>(bytes);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return number_of<uint32_t>(bytes);
  default: return number_of<float>(bytes);
  }
}

/* The largest integer of the type, which stands for 1. */
double largest_of(int component_type)
{
  switch (component_type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
  case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
  default: return 65535;
  }
}

size_t size_or(const JsonValue &json, const char *key, size_t otherwise)
{
  const std::optional<JsonValue> found = json.find(key);
  return found ? found->unsigned_integer() : otherwise;
}

tinygltf::Accessor read_accessor(const JsonValue &json)
{
  static constexpr const char *keys[] = {"bufferView", "byteOffset", "componentType", "normalized",
                                         "count",      "type",       "max",           "min",
                                         "sparse",     "name",       "extras",        "extensions"};
  static constexpr const char *types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  static constexpr int values[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4,
                                   TINYGLTF_TYPE_MAT2,   TINYGLTF_TYPE_MAT3, TINYGLTF_TYPE_MAT4};
  json.only_keys(keys);
  tinygltf::Accessor accessor;
  accessor.type = values[json.member("type").choice(types)];
  const JsonValue component_type = json.member("componentType");
  const uint32_t type = component_type.unsigned_integer();
  if (type < TINYGLTF_COMPONENT_TYPE_BYTE || type > TINYGLTF_COMPONENT_TYPE_FLOAT ||
      type == TINYGLTF_COMPONENT_TYPE_INT)
    component_type.fail(fmt::format("is {}; 5120, 5121, 5122, 5123, 5125 and 5126 exist", type));
  accessor.componentType = int(type);
  accessor.count = json.member("count").unsigned_integer();
  accessor.byteOffset = size_or(json, "byteOffset", 0);
  if (const auto normalized = json.find("normalized")) accessor.normalized = normalized->boolean();
  accessor.sparse.isSparse = json.find("sparse").has_value();
  return accessor;
}

tinygltf::BufferView read_view(const JsonValue &json, size_t buffers)
{
  static constexpr const char *keys[] = {"buffer", "byteOffset", "byteLength", "byteStride",
                                         "target", "name",       "extras",     "extensions"};
  json.only_keys(keys);
  tinygltf::BufferView view;
  view.buffer = gltf_index(json.member("buffer"), "buffer", buffers);
  view.byteOffset = size_or(json, "byteOffset", 0);
  view.byteLength = json.member("byteLength").unsigned_integer();
  if (const auto stride = json.find("byteStride")) {
    view.byteStride = stride->unsigned_integer();
    if (view.byteStride < 4 || view.byteStride > 252 || view.byteStride % 4)
      stride->fail(fmt::format("is {}; a multiple of 4 from 4 to 252 is needed", view.byteStride));
  }
  return view;
}

size_t count_of(const GltfDocument &document, const char *list)
{
  const std::optional<JsonValue> found = document.root().find(list);
  return found ? found->array_size() : 0;
}

int digit_of(char c)
{
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* File names are URIs, in which %20 is a blank. */
std::string percent_decoded(const std::string &text)
{
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? digit_of(text[i + 1]) : -1,
              low = high >= 0 ? digit_of(text[i + 2]) : -1;
    result += low < 0 ? text[i] : char(16 * high + low);
    if (low >= 0) i += 2;
  }
  return result;
}

/* True if the text consists of groups of four characters, with the last padded by one = or two, or cut short. The
 * library would stop at the first =. */
bool is_base64(const std::string &text)
{
  const size_t digits = std::min(text.find('='), text.size()), filled = text.size() - digits;
  const bool plain = std::all_of(text.begin(), text.begin() + ptrdiff_t(digits), [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' || c == '/';
  });
  return plain && text.find_first_not_of('=', digits) == std::string::npos && digits % 4 != 1 &&
         (filled == 0 || (filled <= 2 && text.size() % 4 == 0));
}

} // namespace

JsonValue gltf_item(const GltfDocument &document, const char *list, size_t index, const std::string &where)
{
  return {document.file.value().at(list).at(index), where, fmt::format("{}[{}]", list, index), JsonFloats::numbers};
}

double GltfElements::at(size_t element, size_t component) const
{
  const size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
  const double number = number_of(accessor.componentType, bytes + element * stride + component * size);
  return accessor.normalized ? std::max(number / largest_of(accessor.componentType), -1.0) : number;
}

/* A buffer may be longer than its byteLength, but not shorter. */
std::string GltfBuffers::read_buffer(const JsonValue &json, size_t index, const JsonValue &view) const
{
  static constexpr const char *keys[] = {"uri", "byteLength", "name", "extras", "extensions"};
  json.only_keys(keys);
  const size_t length = json.member("byteLength").unsigned_integer();
  const std::optional<JsonValue> uri = json.find("uri");
  for (const char *packed : packed_views)
    if (gltf_extension_of(view, packed) && (!uri || gltf_extension_of(json, packed)))
      view.fail(fmt::format("a mesh packed by {} is not supported yet", packed));
  std::string bytes;
  if (!uri && index == 0) bytes = document_.binary;
  else if (const std::string text = json.member("uri").text(); text.starts_with("data:")) {
    std::vector<unsigned char> decoded;
    std::string type;
    if (!is_base64(text.substr(text.find(',') + 1)) || !tinygltf::DecodeDataURI(&decoded, type, text, length, false))
      uri->fail("no readable base64 data");
    bytes.assign(decoded.begin(), decoded.end());
  } else bytes = read_file_beside(document_.where, percent_decoded(text), document_.outside, uri->place());
  if (bytes.size() < length) json.fail(fmt::format("has {} bytes; it says {}", bytes.size(), length));
  bytes.resize(length);
  return bytes;
}

const std::string &GltfBuffers::buffer(size_t index, const JsonValue &view, const JsonValue &asks)
{
  const auto known = buffers_.find(index);
  if (known != buffers_.end()) return known->second;
  const std::string where = asks.place();
  return buffers_.emplace(index, read_buffer(gltf_item(document_, "buffers", index, where), index, view)).first->second;
}

GltfElements GltfBuffers::elements_of(uint32_t index, const JsonValue &asks, const char *what)
{
  const size_t accessors = count_of(document_, "accessors");
  if (index >= accessors)
    asks.fail(fmt::format("accessor {} of the {} does not exist; the file has {}", index, what, accessors));
  const std::string where = asks.place();
  const JsonValue json = gltf_item(document_, "accessors", index, where);
  GltfElements elements{read_accessor(json)};
  const tinygltf::Accessor &accessor = elements.accessor;
  if (accessor.sparse.isSparse) asks.fail(fmt::format("a {} of sparse accessors is not supported yet", what));
  if (!json.find("bufferView")) asks.fail(fmt::format("accessor {} of the {} names no buffer view", index, what));
  const auto view_index =
      size_t(gltf_index(json.member("bufferView"), "buffer view", count_of(document_, "bufferViews")));
  const JsonValue view_json = gltf_item(document_, "bufferViews", view_index, where);
  const tinygltf::BufferView view = read_view(view_json, count_of(document_, "buffers"));
  const std::string &bytes = buffer(size_t(view.buffer), view_json, asks);
  const auto stride = size_t(accessor.ByteStride(view));
  const size_t element = size_t(tinygltf::GetNumComponentsInType(uint32_t(accessor.type))) *
                         size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
  const bool view_inside = view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset;
  const size_t remaining =
      view_inside && accessor.byteOffset <= view.byteLength ? view.byteLength - accessor.byteOffset : 0;
  if (stride < element || element > remaining || accessor.count == 0 ||
      accessor.count - 1 > (remaining - element) / stride)
    asks.fail(fmt::format("accessor {} of the {}, {} elements, lies outside its buffer", index, what, accessor.count));
  elements.bytes = bytes.data() + view.byteOffset + accessor.byteOffset;
  elements.count = accessor.count;
  elements.stride = stride;
  return elements;
}

} // namespace tandem
