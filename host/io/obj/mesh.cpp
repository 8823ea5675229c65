/* mesh.cpp - reads vertices and faces line by line and triangulates the faces; see mesh.h. */
#include "host/io/obj/mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <tandem/round_to_float.h>

#include "host/geometry/polygon_crossing.h"
#include "host/io/input_file.h"

namespace tandem {
namespace {

/* Statements that do not define a surface. */
constexpr std::string_view passed_over[] = {
    "vt",     "vn",     "vp",     "p",          "l",         "o",     "g",        "s",        "mg", "usemtl",
    "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp", "lod"};

/* The time to triangulate a face grows with the square of its number of corners. A face with most_corners takes some
 * tenths of a second, which is also the limit for all faces of a file together. */
constexpr size_t most_corners = 10'000, most_squares = most_corners * most_corners;
constexpr size_t many_corners = 100; /* faces with fewer are triangulated as fast as they are read */

struct ObjFace {
  std::vector<int64_t> corners; /* from 0 */
  size_t line;
};

class ObjReader {
public:
  ObjReader(const std::string &text, const std::string &where) : text_(text), where_(where) {}
  void read();
  void check_corners() const;
  void check_crossings() const;
  std::vector<Triangle> triangles() const;

  std::vector<Vec3> vertices;
  std::vector<ObjFace> faces;

private:
  [[noreturn]] void fail(const std::string &why, size_t line) const
  {
    throw InputError(fmt::format("{}: line {}: {}", where_, line, why));
  }
  std::vector<std::string_view> next_words();
  void read_vertex(const std::vector<std::string_view> &words);
  void read_face(const std::vector<std::string_view> &words);
  float number(std::string_view word) const;
  int64_t corner(std::string_view word) const;
  std::vector<Vec3> corners_of(const ObjFace &face) const;
  void check_cut(const ObjFace &face) const;

  std::string_view text_;
  const std::string &where_;
  size_t squares_ = 0; /* of the corners of faces that have many */
  size_t line_ = 0, lines_joined_ = 1;
};

/* A backslash at the end of a line joins it with the next; a # begins a comment. */
std::vector<std::string_view> ObjReader::next_words()
{
  std::vector<std::string_view> words;
  line_ += lines_joined_;
  lines_joined_ = 1;
  bool comment = false;
  for (size_t at = 0; at <= text_.size();) {
    const size_t end = std::min(text_.find_first_of(" \t\r\n", at), text_.size());
    const std::string_view word = text_.substr(at, end - at);
    const bool line_ends = end == text_.size() || text_[end] == '\n';
    const size_t after_return = end < text_.size() && text_[end] == '\r' ? end + 1 : end;
    const bool joins = word == "\\" && after_return < text_.size() && text_[after_return] == '\n';
    comment = comment || word.starts_with("#");
    if (!word.empty() && !comment && !joins) words.push_back(word);
    at = (joins ? after_return : end) + 1;
    if (joins) ++lines_joined_;
    else if (line_ends) {
      text_.remove_prefix(std::min(at, text_.size()));
      return words;
    }
  }
  text_ = {};
  return words;
}

float ObjReader::number(std::string_view word) const
{
  float value = 0;
  const char *end = word.data() + word.size();
  const char *start = word.data() + (word.starts_with("+") && !word.starts_with("+-") ? 1 : 0);
  const auto [stop, error] = std::from_chars(start, end, value);
  if (error == std::errc::result_out_of_range &&
      stop == end) { /* too small for a float becomes 0 or denormal; too large is an error */
    double wide = 0;
    const auto [wide_stop, wide_error] = std::from_chars(start, end, wide);
    if (wide_error == std::errc{} && wide_stop == end && std::abs(wide) < 1) return round_to_float(wide);
  }
  if (error != std::errc{} || stop != end || !std::isfinite(value))
    fail(fmt::format("'{}' is no finite number of 32 bits", word.substr(0, 40)), line_);
  return value;
}

/* A vertex is v x y z, optionally followed by a weight or a colour. */
void ObjReader::read_vertex(const std::vector<std::string_view> &words)
{
  const size_t numbers = words.size() - 1;
  if (numbers < 3 || numbers == 5 || numbers > 7)
    fail(fmt::format("a vertex of {} numbers; 'v x y z' is needed", numbers), line_);
  for (const std::string_view word : words)
    if (word != "v") number(word);
  vertices.push_back({number(words[1]), number(words[2]), number(words[3])});
}

/* "7", "7/2", "7//3" or "7/2/3": the first number is the vertex, and the others must be numbers too. Negative numbers
 * count back from the last vertex. */
int64_t ObjReader::corner(std::string_view word) const
{
  int64_t first = 0;
  size_t parts = 0;
  for (size_t at = 0; at <= word.size(); ++parts) {
    const size_t end = std::min(word.find('/', at), word.size());
    int64_t index = 0;
    const auto [stop, error] = std::from_chars(word.data() + at, word.data() + end, index);
    const bool left_out = at == end && parts == 1 && end < word.size();
    if (parts > 2 || (!left_out && (error != std::errc{} || stop != word.data() + end || index == 0)))
      fail(fmt::format("'{}' is no corner of a face; use a number of a vertex, from 1 on, as in 7, 7/2, 7//3 or 7/2/3",
                       word.substr(0, 40)),
           line_);
    if (parts == 0) first = index;
    at = end + 1;
  }
  if (first > 0) return first - 1;
  const auto before = static_cast<int64_t>(vertices.size());
  if (first < -before) /* the smallest int64 has no positive counterpart */
    fail(fmt::format("a face counts back {} vertices before the first", -(uint64_t(first) + uint64_t(before))), line_);
  return before + first;
}

void ObjReader::read_face(const std::vector<std::string_view> &words)
{
  if (words.size() < 4) fail(fmt::format("a face of {} corners; three are needed at least", words.size() - 1), line_);
  if (words.size() - 1 > most_corners)
    fail(fmt::format("a face of {} corners; more than {} are not cut into triangles: give triangles", words.size() - 1,
                     most_corners),
         line_);
  if (words.size() - 1 > many_corners) squares_ += (words.size() - 1) * (words.size() - 1);
  if (squares_ > most_squares)
    fail(fmt::format("faces of more than {} corners up to here take too long to cut into triangles: give triangles",
                     many_corners),
         line_);
  ObjFace &face = faces.emplace_back();
  face.line = line_;
  for (size_t k = 1; k < words.size(); ++k) face.corners.push_back(corner(words[k]));
}

void ObjReader::read()
{
  while (!text_.empty()) {
    const std::vector<std::string_view> words = next_words();
    if (words.empty()) continue;
    if (words[0] == "v") read_vertex(words);
    else if (words[0] == "f") read_face(words);
    else if (std::find(std::begin(passed_over), std::end(passed_over), words[0]) == std::end(passed_over))
      fail(fmt::format("'{}' begins no line that is known in OBJ files of vertices (v) and faces (f)",
                       words[0].substr(0, 40)),
           line_);
  }
}

/* Faces may precede their vertices in the file. */
void ObjReader::check_corners() const
{
  for (const ObjFace &face : faces)
    for (const int64_t corner : face.corners)
      if (corner >= static_cast<int64_t>(vertices.size()))
        fail(fmt::format("a face names vertex {}, but there are {} (1 is the first)", corner + 1, vertices.size()),
             face.line);
}

std::vector<Vec3> ObjReader::corners_of(const ObjFace &face) const
{
  std::vector<Vec3> corners;
  for (const int64_t corner : face.corners) corners.push_back(vertices[size_t(corner)]);
  return corners;
}

/* Self-crossing quads would be triangulated too, into triangles that overlap. */
void ObjReader::check_crossings() const
{
  for (const ObjFace &face : faces)
    if (crosses_itself(corners_of(face)))
      fail("a polygon crosses itself; give its corners in order, or triangles", face.line);
}

/* The same vertices and faces as text that has only one interpretation. */
std::string plain_text(const std::vector<Vec3> &vertices, const std::vector<ObjFace> &faces)
{
  std::string text;
  for (const Vec3 &v : vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", v[0], v[1], v[2]);
  for (const ObjFace &face : faces) {
    text += "f";
    for (const int64_t corner : face.corners) text += fmt::format(" {}", corner + 1);
    text += "\n";
  }
  return text;
}

/* Returns too few triangles if a face cannot be triangulated. */
std::vector<Triangle> cut(const std::vector<Vec3> &vertices, const std::vector<ObjFace> &faces)
{
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  if (!reader.ParseFromString(plain_text(vertices, faces), "", config)) return {};
  std::vector<Triangle> triangles;
  for (const tinyobj::shape_t &shape : reader.GetShapes())
    for (size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
      Triangle &triangle = triangles.emplace_back();
      for (size_t corner = 0; corner < 3; ++corner)
        triangle[corner] = static_cast<uint32_t>(shape.mesh.indices[i + corner].vertex_index);
    }
  return triangles;
}

void ObjReader::check_cut(const ObjFace &face) const
{
  ObjFace alone{{}, face.line};
  for (size_t k = 0; k < face.corners.size(); ++k) alone.corners.push_back(static_cast<int64_t>(k));
  if (cut(corners_of(face), {alone}).size() != face.corners.size() - 2)
    fail("a polygon that was not cut into triangles, as where it leaves its plane, names a place twice or crosses "
         "itself; "
         "give triangles",
         face.line);
}

std::vector<Triangle> ObjReader::triangles() const
{
  if (faces.empty()) return {};
  size_t expected = 0;
  for (const ObjFace &face : faces) expected += face.corners.size() - 2;
  std::vector<Triangle> triangles = cut(vertices, faces);
  if (triangles.size() == expected) return triangles;
  for (const ObjFace &face : faces) check_cut(face);
  throw InputError(fmt::format("{}: its polygons cannot be cut into triangles; give triangles", where_));
}

} // namespace

ObjMesh parse_obj(const std::string &text, const std::string &where)
{
  const size_t zero = text.find('\0');
  if (zero != std::string::npos)
    throw InputError(fmt::format("{}: line {}: holds a byte of 0; OBJ files are text", where,
                                 1 + std::count(text.begin(), text.begin() + ptrdiff_t(zero), '\n')));
  ObjReader read(text, where);
  read.read();
  read.check_corners();
  read.check_crossings();
  if (read.vertices.empty())
    throw InputError(fmt::format("{}: no vertices (lines 'v x y z'); is it an OBJ file?", where));
  return {read.vertices, read.triangles()};
}

ObjMesh load_obj(const std::string &file) { return parse_obj(read_file(file), file); }

} // namespace tandem
