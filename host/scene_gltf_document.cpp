/* scene_gltf_document.cpp - see scene_gltf_document.h. */
#include "host/scene_gltf_document.h"

#include <fmt/format.h>

namespace tandem {
namespace {

bool ignore_image(tinygltf::Image *, const int, std::string *, std::string *, int, int, const unsigned char *, int, void *) { return true; }

std::string first_line(const std::string &text)
{
  size_t start = text.find_first_not_of(" \n");
  return start == std::string::npos ? "not a readable glTF 2.0 file" : text.substr(start, text.find('\n', start) - start);
}

tinygltf::Model parse_model(const std::string &path)
{
  std::string text = read_file(path), error, warning;
  bool binary = text.compare(0, 4, "glTF") == 0;
  if (!binary) parse_json(text, path); /* for line and column */
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
