/* scene_gltf_document.cpp - see scene_gltf_document.h. */
#include "host/scene_gltf_document.h"

#include <cstring>

#include <fmt/format.h>

namespace tandem {
namespace {

bool ignore_image(tinygltf::Image *, const int, std::string *, std::string *, int, int, const unsigned char *, int, void *) { return true; }

std::string first_line(const std::string &text)
{
  size_t start = text.find_first_not_of(" \n");
  return start == std::string::npos ? "not a readable glTF 2.0 file" : text.substr(start, text.find('\n', start) - start);
}

/* The first chunk of a binary file; what is no such file is left to the parser's complaint. */
std::string json_of_binary(const std::string &text)
{
  uint32_t length = 0;
  if (text.size() < 20 || text.compare(16, 4, "JSON") != 0) return "{}";
  std::memcpy(&length, text.data() + 12, 4);
  return text.size() - 20 < length ? "{}" : text.substr(20, length);
}

/* The parser cuts numbers to 32 bits: one too large would name another node. Here the complaint also knows who names it. */
void check_node_numbers(const nlohmann::json &file, const std::string &where)
{
  const bool has_nodes = file.is_object() && file.contains("nodes") && file["nodes"].is_array();
  const double nodes = has_nodes ? double(file["nodes"].size()) : 0;
  const auto check = [&](const nlohmann::json &owner, const std::string &owner_label, const char *key) {
    const auto list = owner.is_object() ? owner.find(key) : owner.end();
    if (!owner.is_object() || list == owner.end() || !list->is_array()) return;
    for (size_t i = 0; i < list->size(); ++i)
      if (const nlohmann::json &number = (*list)[i]; number.is_number() && !(number.get<double>() >= 0 && number.get<double>() < nodes))
        throw InputError(fmt::format("{}: {}: {}[{}]: node {} does not exist; the file has {}", where, owner_label, key, i, number.dump(), nodes));
  };
  const auto check_all = [&](const char *list, const char *kind, const char *key) {
    const nlohmann::json none = nlohmann::json::array();
    const nlohmann::json &owners = file.is_object() && file.contains(list) ? file[list] : none;
    for (size_t i = 0; owners.is_array() && i < owners.size(); ++i) {
      const bool named = owners[i].is_object() && owners[i].contains("name") && owners[i]["name"].is_string();
      check(owners[i], named ? fmt::format("{} '{}'", kind, owners[i]["name"].get<std::string>()) : fmt::format("{} {}", kind, i), key);
    }
  };
  check_all("nodes", "node", "children");
  check_all("scenes", "scene", "nodes");
}

tinygltf::Model parse_model(const std::string &path)
{
  std::string text = read_file(path), error, warning;
  bool binary = text.compare(0, 4, "glTF") == 0;
  check_node_numbers(parse_json(binary ? json_of_binary(text) : text, path), path); /* for line and column too */
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(ignore_image, nullptr);
  parser.SetStoreOriginalJSONForExtrasAndExtensions(true);
  tinygltf::Model model;
  bool parsed = false;
  try {
    parsed = binary ? parser.LoadBinaryFromFile(&model, &error, &warning, path) : parser.LoadASCIIFromFile(&model, &error, &warning, path);
  } catch (const std::exception &exception) { /* the JSON library under it reports wrong types so */
    error = exception.what();
  }
  if (!parsed) throw InputError(fmt::format("{}: {}", path, first_line(error)));
  return model;
}

void check_extensions(const tinygltf::Model &model, const std::string &where)
{
  for (const std::string &name : model.extensionsRequired)
    if (name != shapes_extension && name != bodies_extension)
      throw InputError(fmt::format("{}: required extension {} is not supported yet; {} and {} are", where, name, shapes_extension, bodies_extension));
}

/* The "extensions" object of the document or of a node; empty when there is none. */
nlohmann::json parse_extensions(const std::string &original, const std::string &where)
{
  nlohmann::json extensions = original.empty() ? nlohmann::json() : parse_json(original, where);
  if (extensions.is_null()) extensions = nlohmann::json::object();
  if (!extensions.is_object()) throw InputError(fmt::format("{}: extensions is not an object", where));
  return extensions;
}

} // namespace

std::string GltfDocument::label(int index) const
{
  const std::string &name = node(index).name;
  return name.empty() ? fmt::format("node {}", index) : fmt::format("node '{}'", name);
}

void GltfDocument::refuse(int index, const std::string &what) const { throw InputError(fmt::format("{}: {}", place(index), what)); }

void GltfDocument::require_node(int index) const
{
  if (index < 0 || size_t(index) >= model.nodes.size())
    throw InputError(fmt::format("{}: node {} does not exist; the file has {}", where, index, model.nodes.size()));
}

nlohmann::json GltfDocument::extensions_of(int index) const { return parse_extensions(node(index).extensions_json_string, place(index)); }

GltfDocument read_gltf_document(const std::string &path)
{
  GltfDocument document;
  document.model = parse_model(path);
  document.where = path;
  check_extensions(document.model, path);
  nlohmann::json extensions = parse_extensions(document.model.extensions_json_string, path);
  document.shapes = extensions.value(shapes_extension, nlohmann::json::object());
  document.bodies = extensions.value(bodies_extension, nlohmann::json::object());
  return document;
}

} // namespace tandem
