/* Invalid meshes, hulls and scales in both kinds of scene files: each is refused in one line that names the node or the
 * place in the file and states the error, or is simulated as it is (with a warning if its mass is a guess). */
#include <limits>

#include "host/io/json/scene.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using namespace tandem::gltf_text;
using Catch::Matchers::ContainsSubstring;

namespace {

using Points = std::vector<Vec3>;
using CornerIndices = std::vector<uint16_t>;

const Points square{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
const CornerIndices square_triangles{0, 2, 1, 0, 3, 2};
const CornerIndices open_tip(tip_triangles.begin(), tip_triangles.end() - 3),
    inside_out(tip_triangles.rbegin(), tip_triangles.rend());

CornerIndices joined(const CornerIndices &first, const CornerIndices &second)
{
  CornerIndices both = first;
  both.insert(both.end(), second.begin(), second.end());
  return both;
}

/* Every corner a vertex of its own. */
Points separated()
{
  Points points;
  for (uint16_t corner : tip_triangles) points.push_back(tip_points[corner]);
  return points;
}
CornerIndices counted(size_t n)
{
  CornerIndices corners(n);
  for (size_t i = 0; i < n; ++i) corners[i] = uint16_t(i);
  return corners;
}

struct Row {
  const char *what;
  Points points;
  CornerIndices triangles;
  bool hull, moves;
  const char *complaint; /* "": none */
  const char *warning;   /* "": none */
};

std::vector<Row> rows()
{
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Points with_nan = tip_points, with_infinity = tip_points;
  with_nan[2][1] = nan;
  with_infinity[3][2] = -infinity;
  const CornerIndices fin = joined(tip_triangles, {0, 1, 4});
  Points with_fin = tip_points;
  with_fin.push_back({1, -1, 1});
  return {
      {"sound", tip_points, tip_triangles, false, true, "", ""},
      {"every corner a vertex", separated(), counted(12), false, true, "", ""},
      {"open, fixed", tip_points, open_tip, false, false, "", ""},
      {"open, moves", tip_points, open_tip, false, true, "", "open mesh: 3 boundary edges"},
      {"an edge of three triangles", with_fin, fin, false, true, "", "open mesh: 2 boundary edges"},
      {"an edge of four", tip_points, joined(tip_triangles, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}), false, false, "",
       ""},
      {"an edge of four, moves", tip_points, joined(tip_triangles, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}), false, true,
       "inside out", ""},
      {"inside out, fixed: a room", tip_points, inside_out, false, false, "", ""},
      {"inside out, moves", tip_points, inside_out, false, true,
       "its triangles are inside out; turn them counter-clockwise seen from outside", ""},
      {"flat, fixed", square, square_triangles, false, false, "", ""},
      {"flat, moves", square, square_triangles, false, true, "a flat mesh of 2 triangles has no volume", ""},
      {"one triangle, fixed", tip_points, {0, 1, 2}, false, false, "", ""},
      {"one triangle, moves", tip_points, {0, 1, 2}, false, true, "a flat mesh of 1 triangles has no volume", ""},
      {"one triangle without area",
       tip_points,
       {0, 1, 1},
       false,
       false,
       "all 1 triangles of the mesh have no area",
       ""},
      {"NaN", with_nan, tip_triangles, false, false, "is [0, nan, 0]; three finite numbers are needed", ""},
      {"infinite", with_infinity, tip_triangles, false, true, "is [0, 0, -inf]; three finite numbers are needed", ""},
      {"hull of a plane", square, square_triangles, true, true, "lie in a plane; a hull needs four that do not", ""},
      {"hull of a plane, fixed", square, square_triangles, true, false, "lie in a plane; a hull needs four that do not",
       ""},
      {"hull of a triangle", tip_points, {0, 1, 2}, true, true, "a hull needs four different points, not 3", ""},
      {"hull of one point four times",
       {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
       {0, 1, 2, 3, 2, 1},
       true,
       true,
       "a hull needs four different points, not 1",
       ""},
      {"hull of NaN", with_nan, tip_triangles, true, true, "is [0, nan, 0]; three finite numbers are needed", ""},
  };
}

/* The message of a reader: its error, or the warnings about the scene. */
struct Verdict {
  std::string complaint;
  std::vector<std::string> warnings;
};
template <class Read> Verdict verdict(const Read &read)
{
  try {
    return {"", warnings_of(read(), "f")};
  } catch (const InputError &error) {
    return {error.what(), {}};
  }
}

void check(const Row &row, const Verdict &said, const std::string &place)
{
  CAPTURE(row.what, said.complaint, said.warnings);
  CHECK(said.complaint.empty() == (*row.complaint == 0));
  CHECK_THAT(said.complaint, ContainsSubstring(row.complaint));
  if (*row.complaint) CHECK_THAT(said.complaint, ContainsSubstring(place));
  CHECK(said.complaint.find('\n') == std::string::npos);
  CHECK(said.warnings.size() == (*row.warning ? 1 : 0));
  if (*row.warning) CHECK_THAT(said.warnings.at(0), ContainsSubstring(row.warning) && ContainsSubstring("'Cup'"));
}

std::string list_of(const Points &points)
{
  std::string text;
  for (const Vec3 &p : points)
    text += (text.empty() ? "[" : ",[") + std::to_string(p[0]) + "," + std::to_string(p[1]) + "," +
            std::to_string(p[2]) + "]";
  return "[" + text + "]";
}
std::string list_of(const CornerIndices &corners)
{
  std::string text;
  for (size_t i = 0; i + 2 < corners.size(); i += 3)
    text += (text.empty() ? "[" : ",[") + std::to_string(corners[i]) + "," + std::to_string(corners[i + 1]) + "," +
            std::to_string(corners[i + 2]) + "]";
  return "[" + text + "]";
}

std::string json_scene(const std::string &shape, const std::string &body)
{
  return R"({"tandem_scene":1,"shapes":[)" + shape + R"(],"bodies":[{"name":"Cup",)" + body + "}]}";
}
std::string json_complaint(const std::string &shape, const std::string &body = R"("motion":"fixed")")
{
  return verdict([&] { return parse_scene_json(json_scene(shape, body), "f"); }).complaint;
}

} // namespace

TEST_CASE("bad meshes of glTF files are named with their node")
{
  for (const Row &row : rows()) {
    const std::string geometry = row.hull ? R"("mesh":0,"convexHull":true)" : R"("mesh":0)",
                      motion = row.moves ? R"("motion":{},)" : "";
    check(row, verdict([&] {
            return loaded({.nodes = cup_of(geometry, "", motion), .more = with_mesh(row.points, row.triangles)});
          }),
          "node 'Cup': ");
  }
}

/* Numbers that are none cannot be written in JSON. */
TEST_CASE("bad meshes of JSON scenes are named with their place")
{
  for (const Row &row : rows()) {
    if (std::string(row.complaint).find("finite") != std::string::npos) continue;
    Points points = row.points;
    if (row.hull) { /* of what the triangles name, as in the other format */
      points.clear();
      for (uint16_t corner : row.triangles) points.push_back(row.points[corner]);
    }
    const std::string shape = row.hull ? R"({"type":"hull","points":)" + list_of(points) + "}"
                                       : R"({"type":"mesh","vertices":)" + list_of(points) + R"(,"triangles":)" +
                                             list_of(row.triangles) + "}";
    const std::string body = row.moves ? R"("shape":0,"density":1000)" : R"("motion":"fixed")";
    const bool of_body = std::string(row.complaint).find("volume") != std::string::npos ||
                         std::string(row.complaint).find("inside out") != std::string::npos;
    check(row, verdict([&] { return parse_scene_json(json_scene(shape, body), "f"); }),
          of_body ? "f: bodies[0].density: " : "f: shapes[0]");
    if (of_body)
      CHECK_THAT(json_complaint(shape, R"("mass":1)"),
                 ContainsSubstring("f: body 0 'Cup': ") && ContainsSubstring(row.complaint));
  }
}

TEST_CASE("a body may be given what its mesh has no volume for")
{
  const std::string flat =
      R"({"type":"mesh","vertices":)" + list_of(square) + R"(,"triangles":)" + list_of(square_triangles) + "}";
  CHECK(json_complaint(flat, R"("mass":1,"inertia":[1,1,1])").empty());
  const std::string motion = R"("motion":{"mass":1,"inertiaDiagonal":[1,1,1],"centerOfMass":[0,0,0]},)";
  CHECK(complaint({.nodes = cup_of(R"("mesh":0)", "", motion), .more = with_mesh(square, square_triangles)}).empty());
  const std::string without_center =
      complaint({.nodes = cup_of(R"("mesh":0)", "", R"("motion":{"mass":1,"inertiaDiagonal":[1,1,1]},)"),
                 .more = with_mesh(square, square_triangles)});
  CHECK_THAT(without_center,
             ContainsSubstring("node 'Cup': motion: without mass, inertiaDiagonal and centerOfMass, all three"));
}

TEST_CASE("scales of zero, and numbers that no node, material or vertex has")
{
  struct Line {
    const char *what;
    Parts parts;
    const char *says;
  };
  const std::string mesh = with_mesh(tip_points, tip_triangles);
  const std::string compound =
      R"({"name":"Cup","children":[1,2],"extensions":{"KHR_physics_rigid_bodies":{"motion":{}}}},)" + collider(0) + ",";
  const Line lines[] = {
      {"zero scale of a mesh",
       {.nodes = cup_of(R"("mesh":0)", R"("scale":[1,0,1],)"), .more = mesh},
       "node 'Cup': its scale is 0 along Y"},
      {"zero scale of all of a body",
       {.nodes = cup("", 0, R"("scale":[0,0,0],)")},
       "node 'Cup': its scale is 0 along X"},
      {"zero scale in a compound",
       {.nodes = compound + collider(0, R"("name":"Lid","scale":[1,1,0],)")},
       "node 'Lid': its scale is 0 along Z"},
      {"a shape that a part lacks",
       {.nodes = compound + collider(7, R"("name":"Lid",)")},
       "node 'Lid': collider.geometry.shape: shape 7 does not exist"},
      {"a material that a part lacks",
       {.nodes = compound + collider(0, R"("name":"Lid",)", R"(,"physicsMaterial":4294967295)")},
       "node 'Lid': collider.physicsMaterial: material 4294967295"},
      {"a child beyond int",
       {.nodes = cup("", 0, R"("children":[4294967296],)")},
       "node 'Cup': children[0]: is 4294967296; an integer from 0 to 4294967295 is needed"},
      {"a child that the file lacks",
       {.nodes = cup("", 0, R"("children":[7],)")},
       "node 'Cup': children[0]: node 7 does not exist; the file has 1"},
      {"a child below 0",
       {.nodes = cup("", 0, R"("children":[-1],)")},
       "node 'Cup': children[0]: is -1; an integer from 0"},
      {"a child of the scene beyond int",
       {.nodes = cup(""), .more = R"(,"scenes":[{"nodes":[0,8589934592]}])"},
       "scenes[0].nodes[1]: is 8589934592; an integer from 0"},
  };
  for (const Line &line : lines) {
    CAPTURE(line.what);
    CHECK_THAT(complaint(line.parts), ContainsSubstring(line.says));
  }
  CHECK_THAT(
      json_complaint(R"({"type":"mesh","vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,2]],"scale":[1,0,1]})"),
      ContainsSubstring("f: shapes[0].scale: scale is [1, 0, 1]"));
  CHECK_THAT(json_complaint(R"({"type":"mesh","vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,3]]})"),
             ContainsSubstring("f: shapes[0]: triangle 0 names vertex 3, but there are 3"));
  CHECK_THAT(json_complaint(R"({"type":"mesh","vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,4294967296]]})"),
             ContainsSubstring("f: shapes[0].triangles[0][2]: is 4294967296; an integer from 0"));
  CHECK_THAT(json_complaint(R"({"type":"compound","children":[]})"),
             ContainsSubstring("f: shape 0: a compound without children; at least one is needed"));
  const auto child = [](const std::string &members) {
    return R"({"type":"compound","children":[{"shape":{"type":"sphere","radius":1}},{)" + members + "}]}";
  };
  CHECK_THAT(json_complaint(child(R"("shape":{"type":"sphere","radius":0})")),
             ContainsSubstring("f: shape 0 child 1: radius is 0"));
  CHECK_THAT(json_complaint(child(R"("shape":{"type":"half_space"})")),
             ContainsSubstring("f: shape 0 child 1: a half_space or compound cannot be a child"));
  CHECK_THAT(json_complaint(child(R"("shape":{"type":"sphere","radius":1},"material":4294967295)")),
             ContainsSubstring("f: body 0 'Cup': material 4294967295 of child 1 does not exist"));
  CHECK_THAT(json_complaint(child(R"("shape":{"type":"sphere","radius":1},"material":4294967296)")),
             ContainsSubstring("f: shapes[0].children[1].material: is 4294967296"));
  CHECK_THAT(json_complaint(child(R"("shape":{"type":"sphere","radius":1},"density":0)")),
             ContainsSubstring("f: shape 0 child 1: density is 0"));
  CHECK_THAT(
      json_complaint(child(R"("shape":{"type":"mesh","vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,2]]})"),
                     R"("density":1)"),
      ContainsSubstring("f: bodies[0].density: ") && ContainsSubstring("a flat mesh of 1 triangles has no volume"));
}
