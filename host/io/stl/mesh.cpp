/* mesh.cpp - tells the two forms of STL apart and reads each; see mesh.h.
 *
 *   binary   80 bytes of any text, a count, and for each triangle 50 bytes: normal, three vertices (twelve floats,
 *            little-endian), two bytes of attributes
 *   ASCII    solid NAME { facet normal n { outer loop { vertex x y z } x 3 endloop } endfacet } endsolid
 *
 * A binary file may begin with "solid", too, so the size decides. */
#include "host/io/stl/mesh.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/base/printable.h"

namespace tandem {
namespace {

constexpr size_t header_bytes = 84, triangle_bytes = 50, normal_bytes = 12;

uint32_t stl_word_at(const std::string &text, size_t at)
{
  uint32_t word = 0;
  for (size_t k = 4; k-- > 0;) word = word << 8 | static_cast<unsigned char>(text[at + k]);
  return word;
}

void add_corner(const Vec3 &corner, ObjMesh &mesh)
{
  mesh.vertices.push_back(corner);
  const auto count = uint32_t(mesh.vertices.size());
  if (count % 3 == 0) mesh.triangles.push_back({count - 3, count - 2, count - 1});
}

ObjMesh parse_binary_stl(const std::string &text, size_t count, const std::string &where)
{
  ObjMesh mesh;
  for (size_t k = 0; k < 3 * count; ++k) {
    const size_t at = header_bytes + k / 3 * triangle_bytes + normal_bytes + k % 3 * 12;
    Vec3 corner;
    for (size_t axis = 0; axis < 3; ++axis) corner[axis] = std::bit_cast<float>(stl_word_at(text, at + 4 * axis));
    for (float x : corner)
      if (!std::isfinite(x))
        throw InputError(fmt::format("{}: triangle {} has a vertex that is not finite", where, k / 3));
    add_corner(corner, mesh);
  }
  return mesh;
}

/* The words of an ASCII file, one after the other, with the line of the last one. */
class StlWords {
public:
  StlWords(const std::string &text, const std::string &where) : text_(text), where_(where) {}
  std::string_view next();
  void skip_line();
  float number();
  bool is_next(std::string_view wanted) { return next() == wanted; }
  [[noreturn]] void fail(const std::string &why) const
  {
    throw InputError(fmt::format("{}: line {}: {}", where_, line_, printable(why)));
  }

private:
  std::string_view text_;
  const std::string &where_;
  size_t at_ = 0, line_ = 1;
};

std::string_view StlWords::next()
{
  for (; at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos; ++at_)
    line_ += text_[at_] == '\n';
  const size_t start = at_;
  at_ = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
  return text_.substr(start, at_ - start);
}

void StlWords::skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

float StlWords::number()
{
  std::string_view word = next();
  const std::string shown(word.substr(0, 40));
  if (word.starts_with("+") && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(round_to_float(value)))
    fail(fmt::format("\"{}\" is no finite number of 32 bits", shown));
  return round_to_float(value);
}

void read_facet(StlWords &words, ObjMesh &mesh)
{
  const auto expect = [&](const char *wanted) {
    if (!words.is_next(wanted)) words.fail(fmt::format("\"{}\" is needed here", wanted));
  };
  expect("normal");
  for (int k = 0; k < 3; ++k) words.next(); /* the normal; some programs write nan for one that is not known */
  expect("outer");
  expect("loop");
  for (int k = 0; k < 3; ++k) {
    expect("vertex");
    const float x = words.number(), y = words.number(), z = words.number();
    add_corner({x, y, z}, mesh);
  }
  expect("endloop");
  expect("endfacet");
}

ObjMesh parse_ascii_stl(const std::string &text, const std::string &where)
{
  StlWords words(text, where);
  if (!words.is_next("solid")) words.fail("neither \"solid\" nor a binary STL file, whose size fits its count");
  words.skip_line();
  ObjMesh mesh;
  for (;;) {
    const std::string_view word = words.next();
    if (word == "facet") read_facet(words, mesh);
    else if (word == "endsolid") break;
    else
      words.fail(word.empty() ? "the file ends before \"endsolid\""
                              : fmt::format("\"{}\" begins no facet", std::string(word.substr(0, 40))));
  }
  return mesh;
}

} // namespace

ObjMesh parse_stl(const std::string &text, const std::string &where)
{
  if (text.size() >= header_bytes) {
    const size_t count = stl_word_at(text, header_bytes - 4), expected = header_bytes + count * triangle_bytes;
    if (text.size() == expected) return parse_binary_stl(text, count, where);
    if (!text.starts_with("solid"))
      throw InputError(
          fmt::format("{}: {} triangles need {} bytes, and the file has {}", where, count, expected, text.size()));
  }
  return parse_ascii_stl(text, where);
}

} // namespace tandem
