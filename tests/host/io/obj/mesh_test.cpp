/* mesh_test.cpp - vertices and faces of OBJ files, and the messages about invalid files. */
#include <cmath>

#include "host/geometry/mass_properties.h"
#include "host/io/obj/mesh.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;
using Catch::Matchers::ContainsSubstring;

namespace {

/* A cube of side 2 in quads and two groups, with normals, textures, comments and a material that is not there. */
const std::string cube = R"(# a cube
mtllib missing.mtl
o cube
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
vt 0 0
vn 0 0 1
g ends
usemtl stone
f 5//1 6//1 7//1 8//1
f 4/1 3/1 2/1 1/1
g sides
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f -5 -8 -4 -1
)";

std::string refusal(const std::string &text)
{
  return complaint([&] { parse_obj(text, "cube.obj"); });
}

} // namespace

TEST_CASE("obj: polygons of all groups become triangles, seen from the same side")
{
  const ObjMesh mesh = parse_obj(cube, "cube.obj");
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.triangles.size() == 12);
  CHECK(mesh.vertices[6] == Vec3{1, 1, 1});
  const TriangleMesh checked = triangle_mesh(mesh.vertices, mesh.triangles, "cube.obj");
  CHECK(volume_warning(checked).empty());
  CHECK(mesh_mass(checked, "cube.obj").mass == Approx(8));
}

TEST_CASE("obj: numbers are read to the nearest float, or its neighbour")
{
  const ObjMesh mesh = parse_obj("v 0.1 -1.5e-3 123456.789\nv 1e10 -0 3.4028234e38\n", "a.obj");
  CHECK(mesh.vertices[0][0] == Approx(0.1).epsilon(1.2e-7));
  CHECK(mesh.vertices[0][1] == Approx(-1.5e-3).epsilon(1.2e-7));
  CHECK(mesh.vertices[0][2] == Approx(123456.789).epsilon(1.2e-7));
  CHECK(mesh.vertices[1][0] == Approx(1e10).epsilon(1.2e-7));
  CHECK(mesh.triangles.empty()); /* a cloud of points */
}

TEST_CASE("obj: what is no shape is refused in one line with the file's name")
{
  CHECK_THAT(refusal(""), ContainsSubstring("cube.obj: no vertices"));
  CHECK_THAT(refusal("{\"not\": \"an OBJ file\"}\n"),
             ContainsSubstring("cube.obj: line 1: '{\"not\":' begins no line that is known"));
  for (const std::string face : {"f 1 2 4\n", "f 1 2 -9\n", "f 0 1 2\n"}) {
    const std::string said = refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + face);
    INFO(face << said);
    CHECK_THAT(said, ContainsSubstring("cube.obj: "));
    CHECK(said.find('\n') == std::string::npos);
  }
  CHECK_THAT(refusal("v 0 0 0\nv 1 0 0\nf 1 2 4\n"), ContainsSubstring("a face names vertex 4, but there are 2"));
  CHECK_THAT(refusal("f -9223372036854775808 2 3\n"),
             ContainsSubstring("line 1: a face counts back 9223372036854775808 vertices before the first"));
  CHECK_THAT(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9223372036854775808 2 3\n"),
             ContainsSubstring("line 4: a face counts back 9223372036854775805 vertices"));
  for (const char *number : {"+-1", "-+1", "++1", "--1", "+", "+-inf", "+-1e-50"})
    CHECK_THAT(refusal("v 0 0 " + std::string(number) + "\n"), ContainsSubstring("is no finite number of 32 bits"));
  CHECK_THAT(refusal("v 0 0 0\nv 1 0 0\nf 1 2 -9\n"),
             ContainsSubstring("a face counts back 7 vertices before the first"));
  CHECK_THAT(complaint([] { load_obj("/no/such/file.obj"); }), ContainsSubstring("/no/such/file.obj"));
}

TEST_CASE("obj: no line is taken for what it is not")
{
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  for (const char *vertex : {"v nan nan nan", "v inf 0 0", "v abc", "v", "v 1", "v 1 2", "v 1 2 x", "v 1,2,3",
                             "v 1 2 3 4 5", "v 1 2 3 4 5 6 7 8", "v 1e39 0 0", "v 1e999 0 0", "v 0x1p2 0 0",
                             "v 1 2 3 w", "v 1.5.2 0 0", "v --1 0 0", "v 1 2 3/4"}) {
    INFO(vertex);
    CHECK_THAT(refusal(corners + vertex + "\nf 1 2 3\n"), ContainsSubstring("cube.obj: line 5: "));
  }
  for (const char *face : {"f",
                           "f 1",
                           "f 1 2",
                           "f 0 1 2",
                           "f 1 2 0",
                           "f a b c",
                           "f 1 2 x",
                           "f 1.5 2 3",
                           "f 1/ 2/ 3/",
                           "f 1/x 2 3",
                           "f 1/0 2 3",
                           "f /1 2 3",
                           "f 1/1/1/1 2 3",
                           "f 1//  2 3",
                           "f 1 2 5",
                           "f 1 2 3 999999",
                           "f 1 2 3 4 5",
                           "f 1 2 -9",
                           "f -5 -1 -2",
                           "f 1 2 3 -9999999999999999999",
                           "f 1 2 99999999999999999999",
                           "f 1 2 3 4 2147483648",
                           "f 1 2 4294967297",
                           "f 1 2 3 # 4\nf 1 2 3 5",
                           "f 1 \\\n2 9"}) {
    INFO(face);
    CHECK_THAT(refusal(corners + face + "\n"), ContainsSubstring("cube.obj: line "));
  }
  for (const char *line :
       {"face 1 2 3", "V 0 0 0", "F 1 2 3", "curv 0 1 1 2", "surf 0 1 0 1", "fo 1 2 3", "<html>", "solid cube"}) {
    INFO(line);
    CHECK_THAT(refusal(corners + line + "\n"), ContainsSubstring("begins no line that is known"));
  }
}

TEST_CASE("obj: what is written in other ways is read all the same")
{
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  const auto triangles = [&](const std::string &text) { return parse_obj(text, "cube.obj").triangles; };
  const std::vector<Triangle> one{{0, 1, 2}};
  CHECK(triangles(corners + "f 1 2 3\n") == one);
  CHECK(triangles(corners + "  f\t1/1 2//1   3/1/1 # why not\r\n") == one);
  CHECK(triangles(corners + "f 1 2 \\\n3") == one);
  CHECK(triangles(corners + "f 1 2 \\\r\n 3") == one);
  CHECK(triangles("f 1 2 3\n" + corners) == one); /* faces before vertices */
  CHECK(triangles(corners + "f -4 -3 -2\nv 5 5 5\n") == one);
  CHECK(triangles(corners + "o a\ng b c\ns off\nusemtl x\nl 1 2\np 1\nvt 0 0\nvn 0 0 1\nf 1 2 3\n#f 9 9 9\n") == one);
  CHECK(triangles(corners + "f 1 2 4 3\n").size() == 2);
  CHECK(triangles("f 1 2 4 3\ng later\n" + corners).size() == 2);
  const ObjMesh colored = parse_obj("v 1 2 3 0.5\nv 1 +2 3e0 1 0 0\nv 1e-60 -1e-60 0\n", "cube.obj");
  REQUIRE(colored.vertices.size() == 3);
  CHECK(colored.vertices[1] == Vec3{1, 2, 3});
  CHECK(colored.vertices[2] == Vec3{0, 0, 0});
}

TEST_CASE("obj: a polygon that crosses itself is refused, in any plane and with any number of corners")
{
  const auto polygon = [](const std::vector<std::array<double, 2>> &corners, int plane, double lean) {
    std::string text, face = "f";
    for (size_t i = 0; i < corners.size(); ++i) {
      double v[3] = {};
      v[plane] = corners[i][0], v[(plane + 1) % 3] = corners[i][1], v[(plane + 2) % 3] = lean * corners[i][0];
      text += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
      face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
  };
  for (int plane = 0; plane < 3; ++plane)
    for (const double lean : {0.0, 0.5, -3.0}) {
      INFO("plane " << plane << ", lean " << lean);
      const auto crosses = [&](const std::vector<std::array<double, 2>> &corners) {
        return refusal(polygon(corners, plane, lean)).find("a polygon crosses itself") != std::string::npos;
      };
      CHECK(crosses({{0, 0}, {1, 1}, {1, 0}, {0, 1}})); /* its halves cancel */
      CHECK(crosses({{0, 0}, {4, 4}, {4, 0}, {0, 1}}));
      CHECK(crosses({{0, 0}, {1, 3}, {2, 0}, {-0.5, 2}, {2.5, 2}})); /* a star */
      CHECK_FALSE(crosses({{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
      CHECK_FALSE(crosses({{0, 0}, {0, 1}, {1, 1}, {1, 0}}));
      CHECK_FALSE(crosses({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}));
    }
  CHECK(refusal("v 0 0 0\nv 1 0.5 0\nv 1 0 1\nv 0 0.5 1\nf 1 2 3 4\n").empty()); /* a saddle, in no plane */
}

TEST_CASE("obj: a polygon that cannot be cut, or not in reasonable time, is named by its line")
{
  const std::string twisted = "v 0 1 1\nv 1 1 1\nv 1 2 1\nv 1 2 0\nv 2 0 0\n";
  CHECK_THAT(refusal(twisted + "f 1 2 3\nf 1 2 3 4 5\nf 1 3 4\n"),
             ContainsSubstring("cube.obj: line 7: a polygon that was not cut into triangles"));
  const auto circle = [](int n) {
    std::string text, face = "f";
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * 3.14159265358979 * k / n;
      text += "v " + std::to_string(1000 * std::cos(angle)) + " 0 " + std::to_string(1000 * std::sin(angle)) + "\n";
      face += " " + std::to_string(k + 1);
    }
    return text + face + "\n";
  };
  CHECK(parse_obj(circle(3000), "circle.obj").triangles.size() == 2998);
  CHECK_THAT(refusal(circle(10'001)), ContainsSubstring("line 10002: a face of 10001 corners; more than 10000"));
  std::string twice = circle(8000);
  twice += twice.substr(twice.find("f "));
  CHECK_THAT(refusal(twice), ContainsSubstring("line 8002: faces of more than 100 corners up to here take too long"));
}
