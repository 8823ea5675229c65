/* obj.cpp - see obj.h. */
#include "host/geometry/obj.h"

#include <algorithm>
#include <fmt/format.h>

#include <tiny_obj_loader.h>

#include "host/json_reader.h"

namespace tandem {
namespace {

std::string one_line(std::string text)
{
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

uint32_t checked(int index, size_t vertices, const std::string &where)
{
  if (index < 0) /* those that count backwards come as numbers from the start */
    throw InputError(fmt::format("{}: a face counts back {} vertices before the first", where, -index));
  if (size_t(index) >= vertices)
    throw InputError(fmt::format("{}: a face names vertex {}, but there are {} (1 is the first)", where, index + 1, vertices));
  return uint32_t(index);
}

} // namespace

ObjMesh parse_obj(const std::string &text, const std::string &where)
{
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  if (!reader.ParseFromString(text, "", config)) throw InputError(fmt::format("{}: no OBJ file: {}", where, one_line(reader.Error())));
  ObjMesh mesh;
  const std::vector<tinyobj::real_t> &numbers = reader.GetAttrib().vertices;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3) mesh.vertices.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  if (mesh.vertices.empty()) throw InputError(fmt::format("{}: no vertices (lines 'v x y z'); is it an OBJ file?", where));
  for (const tinyobj::shape_t &shape : reader.GetShapes())
    for (size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
      Triangle &triangle = mesh.triangles.emplace_back();
      for (size_t corner = 0; corner < 3; ++corner)
        triangle[corner] = checked(shape.mesh.indices[i + corner].vertex_index, mesh.vertices.size(), where);
    }
  return mesh;
}

ObjMesh load_obj(const std::string &file) { return parse_obj(read_file(file), file); }

} // namespace tandem
