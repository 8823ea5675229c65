/* animation.cpp - reads the targets of animations, and first keys; see animation.h. It follows the glTF 2.0
 * specification, chapter 3.11, and KHR_animation_pointer. */
#include "host/io/gltf/animation.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "host/io/gltf/buffers.h"

namespace tandem {
namespace {

/* A property of a node: translation, rotation, scale; others, such as the weights of a mesh, move no node. */
struct Target {
  int node;
  std::string property;
};

/* KHR_animation_pointer names its target by a path such as /nodes/3/translation. */
std::optional<Target> target_of_pointer(const JsonValue &pointer, const GltfDocument &document)
{
  const std::string path = pointer.member("pointer").text(), nodes = "/nodes/";
  if (path.find(bodies_extension) != std::string::npos || path.find(shapes_extension) != std::string::npos)
    pointer.fail(fmt::format("an animation of {} is not supported yet", path));
  if (!path.starts_with(nodes)) return {};
  const size_t end_of_digits = std::min(path.find('/', nodes.size()), path.size());
  const std::string digits = path.substr(nodes.size(), end_of_digits - nodes.size()),
                    property = path.substr(std::min(end_of_digits + 1, path.size()));
  if (property != "matrix" && GltfKeys::number_of(property) == GltfKeys::count) return {};
  uint32_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size() || index >= document.nodes.size())
    pointer.fail(fmt::format("node {} does not exist; the file has {}", digits.substr(0, 40), document.nodes.size()));
  return Target{int(index), property};
}

std::optional<Target> target_of(const JsonValue &target, const GltfDocument &document)
{
  if (const auto pointer = gltf_extension_of(target, "KHR_animation_pointer"))
    if (const auto found = target_of_pointer(*pointer, document)) return found;
  const std::optional<JsonValue> node = target.find("node");
  const std::string path = node ? target.member("path").text() : "";
  if (!node || path == "weights") return {};
  return Target{gltf_index(*node, "node", document.nodes.size()), path};
}

/* The nodes with physics, and all above them. */
std::vector<bool> nodes_of_bodies(const GltfDocument &document)
{
  std::vector<int> parents(document.nodes.size(), -1);
  for (size_t i = 0; i < document.nodes.size(); ++i)
    for (const int child : document.nodes[i].children) parents[size_t(child)] = int(i);
  std::vector<bool> found(document.nodes.size());
  for (size_t i = 0; i < document.nodes.size(); ++i)
    if (document.nodes[i].physics)
      for (int node = int(i); node >= 0 && !found[size_t(node)]; node = parents[size_t(node)])
        found[size_t(node)] = true;
  return found;
}

/* Of a cubic spline each key is three elements, and the second of these is the value. */
std::vector<double> first_key(const JsonValue &sampler, size_t components, GltfBuffers &buffers)
{
  static constexpr const char *interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
  const std::optional<JsonValue> interpolation = sampler.find("interpolation");
  const size_t element = interpolation && interpolation->choice(interpolations) == 2 ? 1 : 0;
  const JsonValue output = sampler.member("output");
  const GltfElements keys = buffers.elements_of(output.unsigned_integer(), output, "animation");
  const int type = keys.accessor.type;
  if (type != (components == 4 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3) || keys.count <= element)
    output.fail(fmt::format("keys of {} numbers each are needed", components));
  std::vector<double> value;
  for (size_t k = 0; k < components; ++k) {
    value.push_back(keys.at(element, k));
    if (!std::isfinite(value.back())) output.fail("the first key is not finite");
  }
  return value;
}

void stand_at_first_keys(int index, const GltfKeys &keys, GltfBuffers &buffers, GltfDocument &document)
{
  GltfNode &node = document.nodes[size_t(index)];
  if (!node.matrix.empty())
    document.refuse(index, "is animated and has a matrix; translation, rotation and scale are needed");
  std::vector<double> *properties[] = {&node.translation, &node.rotation, &node.scale};
  for (size_t k = 0; k < GltfKeys::count; ++k) {
    if (!keys.samplers[k]) continue;
    const auto [animation, sampler] = *keys.samplers[k];
    const JsonValue samplers = gltf_item(document, "animations", animation, document.place(index)).member("samplers");
    if (sampler >= samplers.array_size())
      samplers.fail(fmt::format("sampler {} does not exist; the animation has {}", sampler, samplers.array_size()));
    *properties[k] = first_key(samplers.element(sampler), k == 1 ? 4 : 3, buffers);
  }
}

} // namespace

size_t GltfKeys::number_of(const std::string &property)
{
  static constexpr const char *names[count] = {"translation", "rotation", "scale"};
  return size_t(std::find(names, names + count, property) - names);
}

void read_gltf_animations(GltfDocument &document)
{
  const std::optional<JsonValue> animations = document.root().find("animations");
  for (size_t i = 0; animations && i < animations->array_size(); ++i) {
    const JsonValue channels = animations->element(i).member("channels");
    for (size_t c = 0; c < channels.array_size(); ++c) {
      const JsonValue channel = channels.element(c);
      const std::optional<Target> target = target_of(channel.member("target"), document);
      if (!target) continue;
      GltfKeys &keys = document.animated[target->node];
      const size_t k = GltfKeys::number_of(target->property);
      if (k < GltfKeys::count && !keys.samplers[k])
        keys.samplers[k] = {i, size_t{channel.member("sampler").unsigned_integer()}};
    }
  }
}

void stand_at_first_keys(GltfDocument &document)
{
  GltfBuffers buffers(document);
  const std::vector<bool> matters = nodes_of_bodies(document);
  for (const auto &[node, keys] : document.animated)
    if (matters[size_t(node)]) stand_at_first_keys(node, keys, buffers, document);
}

} // namespace tandem
