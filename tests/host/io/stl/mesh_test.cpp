/* mesh_test.cpp - triangles of STL files in both forms, and the messages about invalid files. */
#include <bit>

#include <fmt/format.h>

#include "host/geometry/mass_properties.h"
#include "host/io/stl/mesh.h"
#include "tests/host/io/robot_text.h"

using namespace tandem;
using namespace tandem::geometry_test;

namespace {

std::string little_endian(uint32_t word)
{
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += char(word >> 8 * k & 0xff);
  return bytes;
}

/* A box of 2 m by 4 m by 6 m; header: its first bytes. */
std::string binary_box(const std::string &header = "binary")
{
  const std::vector<Vec3> corners = box_corners(1, 2, 3);
  std::string text = header + std::string(80 - header.size(), ' ') + little_endian(12);
  for (const Triangle &triangle : box_triangles()) {
    text += std::string(12, '\0');
    for (uint32_t corner : triangle)
      for (float x : corners[corner]) text += little_endian(std::bit_cast<uint32_t>(x));
    text += std::string(2, '\0');
  }
  return text;
}

std::string ascii_box()
{
  const std::vector<Vec3> corners = box_corners(1, 2, 3);
  std::string text = "solid a box\n";
  for (const Triangle &triangle : box_triangles()) {
    text += "  facet normal nan 0 0\n    outer loop\n";
    for (uint32_t corner : triangle)
      text += fmt::format("      vertex {} {} {:e}\r\n", corners[corner][0], corners[corner][1], corners[corner][2]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a box\n";
}

void check_is_box(const ObjMesh &read)
{
  const TriangleMesh mesh = triangle_mesh(read.vertices, read.triangles, "box");
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.triangles.size() == 12);
  const MassProperties solid = mesh_mass(mesh, "box");
  CHECK(solid.mass == Approx(2 * 4 * 6));
  CHECK(solid.inertia.xx == Approx(solid.mass / 12 * (16 + 36)));
}

std::string stl_complaint(const std::string &text)
{
  return complaint([&] { parse_stl(text, "box.stl"); });
}

} // namespace

TEST_CASE("stl: both forms give the same closed box")
{
  check_is_box(parse_stl(binary_box(), "box.stl"));
  check_is_box(parse_stl(binary_box("solid, but binary"), "box.stl"));
  check_is_box(parse_stl(ascii_box(), "box.stl"));
}

TEST_CASE("stl: a file that is cut short or has a wrong count is refused, wherever it ends")
{
  const std::string binary = binary_box(), ascii = ascii_box();
  for (size_t size = 0; size < binary.size(); ++size) CHECK(!stl_complaint(binary.substr(0, size)).empty());
  for (size_t size = 0; size + 8 < ascii.size(); ++size) CHECK(!stl_complaint(ascii.substr(0, size)).empty());
  for (const uint32_t count : {0u, 11u, 13u, 0x7fffffffu, 0xffffffffu}) {
    std::string wrong = binary;
    wrong.replace(80, 4, little_endian(count));
    CHECK_THAT(stl_complaint(wrong), Catch::Matchers::ContainsSubstring(fmt::format("{} triangles need", count)));
  }
}

TEST_CASE("stl: numbers that are not finite, and other words, are refused with their line")
{
  std::string infinite = binary_box();
  infinite.replace(84 + 50 + 12, 4, little_endian(0x7f800000u));
  robot_text::check_one_line(stl_complaint(infinite), "box.stl: triangle 1 ", "not finite");
  const std::string start = "solid s\nfacet normal 0 0 1\nouter loop\nvertex ";
  for (const char *number : {"nan 0 0", "0 1e400 0", "0 1e39 0", "0 0 inf", "0 0 0x1", "1,5 0 0", "- 0 0"})
    robot_text::check_one_line(stl_complaint(start + number + "\n"),
                               "box.stl: line 4: ", "no finite number of 32 bits");
  robot_text::check_one_line(stl_complaint("solid s\nfacet abnormal 0 0 1\n"),
                             "box.stl: line 2: ", "\"normal\" is needed");
  robot_text::check_one_line(stl_complaint("solid s\nfacets\n"), "box.stl: line 2: ", "begins no facet");
  robot_text::check_one_line(stl_complaint("v 0 0 0\n"), "box.stl: line 1: ", "neither \"solid\"");
}
