/* scene_test.cpp - a written scene reads back to the same bits, and every error in a file is reported with its
 * place. */
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "host/geometry/shape_mass.h"
#include "host/io/input_file.h"
#include "host/io/json/reader.h"
#include "host/io/json/scene.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

const std::string json_scenes = std::string(TANDEM_SOURCE_DIR) + "/tests/scenes/";

std::string scene_fault(const std::string &text)
{
  try {
    parse_scene_json(text, "pile.json");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/* A scene of one box, with the given text inside the body. */
std::string with_body(const std::string &fields)
{
  return R"({"tandem_scene": 1, "shapes": [{"type": "box", "half_extents": [1, 1, 1]}], "bodies": [{"name": "first"},)"
         R"( {)" +
         fields + "}]}";
}

template <typename T> bool same_bits(const T &a, const T &b) { return std::memcmp(&a, &b, sizeof(T)) == 0; }

bool same_bits(const Shape &a, const Shape &b)
{
  if (a.type != b.type || !same_bits(a.size, b.size) || bool(a.hull) != bool(b.hull)) return false;
  if (!a.hull) return true;
  const ConvexHull &x = *a.hull, &y = *b.hull;
  if (x.vertices.size() != y.vertices.size() || x.planes.size() != y.planes.size() || x.faces != y.faces ||
      x.edges != y.edges)
    return false;
  return std::equal(x.vertices.begin(), x.vertices.end(), y.vertices.begin(),
                    [](const Vec3 &v, const Vec3 &w) { return same_bits(v, w); }) &&
         std::equal(x.planes.begin(), x.planes.end(), y.planes.begin(),
                    [](const HullPlane &v, const HullPlane &w) { return same_bits(v, w); }) &&
         same_bits(x.centroid, y.centroid) && same_bits(x.tolerance, y.tolerance);
}

bool same_bits(const Material &a, const Material &b)
{
  return a.name == b.name && same_bits(a.static_friction, b.static_friction) &&
         same_bits(a.dynamic_friction, b.dynamic_friction) && same_bits(a.restitution, b.restitution) &&
         same_bits(a.rolling_friction, b.rolling_friction) && same_bits(a.spinning_friction, b.spinning_friction) &&
         a.friction_combine == b.friction_combine && a.restitution_combine == b.restitution_combine;
}

bool same_bits(const Body &a, const Body &b)
{
  return a.name == b.name && a.type == b.type && a.trigger == b.trigger && a.shape == b.shape &&
         a.material == b.material && same_bits(a.position, b.position) && same_bits(a.orientation, b.orientation) &&
         same_bits(a.shape_position, b.shape_position) && same_bits(a.shape_orientation, b.shape_orientation) &&
         same_bits(a.linear_velocity, b.linear_velocity) && same_bits(a.angular_velocity, b.angular_velocity) &&
         same_bits(a.mass, b.mass) && same_bits(a.inertia, b.inertia) && a.infinite_inertia == b.infinite_inertia &&
         same_bits(a.gravity_factor, b.gravity_factor) && same_bits(a.linear_damping, b.linear_damping) &&
         same_bits(a.angular_damping, b.angular_damping) && a.filter_group == b.filter_group &&
         a.filter_mask == b.filter_mask && a.continuous == b.continuous && a.linear_locks == b.linear_locks &&
         a.angular_locks == b.angular_locks && same_bits(a.max_linear_speed, b.max_linear_speed) &&
         same_bits(a.max_angular_speed, b.max_angular_speed) && a.user_data == b.user_data;
}

void check_same(const Scene &a, const Scene &b)
{
  CHECK(a.name == b.name);
  CHECK(same_bits(a.gravity, b.gravity));
  REQUIRE(a.shapes.size() == b.shapes.size());
  REQUIRE(a.materials.size() == b.materials.size());
  REQUIRE(a.bodies.size() == b.bodies.size());
  for (size_t i = 0; i < a.shapes.size(); ++i) CHECK(same_bits(a.shapes[i], b.shapes[i]));
  for (size_t i = 0; i < a.materials.size(); ++i) CHECK(same_bits(a.materials[i], b.materials[i]));
  for (size_t i = 0; i < a.bodies.size(); ++i) CHECK(same_bits(a.bodies[i], b.bodies[i]));
}

/* Any finite bit pattern: denormals, -0, and the largest. */
float any_float(Random &random)
{
  for (;;) {
    auto value = std::bit_cast<float>(uint32_t(random.next()));
    if (std::isfinite(value)) return value;
  }
}

Vec3 any_vector(Random &random) { return {any_float(random), any_float(random), any_float(random)}; }

std::vector<Vec3> any_cloud(Random &random, int count)
{
  std::vector<Vec3> points(size_t(count), Vec3{});
  for (Vec3 &p : points)
    for (float &x : p) x = float(random.uniform(-1, 1));
  return points;
}

Scene scene_of_odd_numbers()
{
  Random random(2026);
  Scene scene;
  scene.name = "odd \"quoted\" \\ \n ünï";
  scene.gravity = any_vector(random);
  scene.shapes = {sphere_shape(0.1f),
                  box_shape(0x1p-100f, 3.3333333f, 0x1.fffffep+28f),
                  half_space_shape(),
                  {ShapeType::sphere, {1, 2, 3}},
                  capsule_shape(0.1f, 0x1.234568p-3f),
                  {ShapeType::capsule, {0.1f, 0.3f, 0.7f}},
                  cylinder_shape(0.3333333f, 1e-3f),
                  {ShapeType::cylinder, {0.1f, 0.3f, 0.7f}},
                  cone_shape(0.7f, 0.3f),
                  {ShapeType::cylinder, {0, 0.3f, 0.7f}},
                  hull_shape(any_cloud(random, 30), "cloud"),
                  hull_shape(any_cloud(random, 4), "tetrahedron")};
  scene.shapes.back().size = {1, -0.0f, 3}; /* ignored, and kept */
  scene.materials.resize(2);
  scene.materials[1] = {"glue", 0x1p-149f, 1e9f, 0.3f, Combine::multiply, Combine::average, 0x1p-140f, 0.1f};
  for (int i = 0; i < 200; ++i) {
    Body body;
    body.name = i % 2 ? "b" + std::to_string(i) : "";
    body.type = BodyType(i % 3);
    body.trigger = i % 11 == 0;
    body.shape = uint32_t(i) % 2 ? 0 : 3;
    body.material = uint32_t(i) % 2;
    for (double &x : body.position) x = std::fmod(double(any_vector(random)[0]) * 1.000000001, 1e18);
    body.orientation = random.orientation();
    body.linear_velocity = any_vector(random);
    body.angular_velocity = {0, -0.0f, 0};
    body.mass = std::bit_cast<float>(uint32_t(0x3f000000u + (random.next() & 0xffffffu)));
    body.inertia = i % 5 ? Vec3{0, 0, 0} : Vec3{0.1f, 0.2f, 0.3f};
    body.infinite_inertia = i % 7 == 0;
    body.gravity_factor = any_float(random);
    body.linear_damping = std::abs(any_float(random));
    body.filter_group = uint32_t(random.next());
    body.filter_mask = uint32_t(random.next());
    body.continuous = random.below(2) == 1;
    body.linear_locks = {random.below(2) == 1, random.below(2) == 1, random.below(2) == 1};
    body.angular_locks = {random.below(2) == 1, random.below(2) == 1, random.below(2) == 1};
    if (i % 3 == 0) body.max_linear_speed = std::abs(any_float(random)) + 0x1p-100f;
    if (i % 3 == 1) body.max_angular_speed = 0x1p-149f;
    body.user_data = i % 2 ? random.next() : 0;
    scene.bodies.push_back(body);
  }
  for (uint32_t shape = 4; shape < scene.shapes.size(); ++shape) {
    Body body;
    body.shape = shape;
    body.orientation = random.orientation();
    body.shape_position = {0.1f, -0.0f, 1e-30f};
    body.shape_orientation = random.orientation();
    body.inertia = {0.1f, 0.2f, 0.3f};
    scene.bodies.push_back(body);
  }
  return scene;
}

} // namespace

TEST_CASE("a written scene reads back to the same bits")
{
  Scene odd = scene_of_odd_numbers();
  std::string text = to_scene_json(odd);
  check_same(odd, parse_scene_json(text, "odd"));
  CHECK(to_scene_json(parse_scene_json(text, "odd")) == text);
  Scene mixed = load_scene("mixed:n=50");
  std::string path =
      (std::filesystem::temp_directory_path() / ("tandem_mixed_" + std::to_string(getpid()) + ".json")).string();
  write_scene_json(mixed, path);
  check_same(mixed, load_scene(path));
  std::remove(path.c_str());
}

TEST_CASE("a file written by hand is read")
{
  Scene scene = load_scene(json_scenes + "three_bodies.json");
  CHECK(scene.name == "three bodies");
  CHECK(scene.gravity == Vec3{0, -9.81f, 0});
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.bodies[0].type == BodyType::fixed);
  CHECK(scene.shapes[scene.bodies[0].shape].type == ShapeType::half_space);
  CHECK(scene.bodies[1].mass == 2.5f);
  CHECK(scene.bodies[1].position == Point{0, 3, -0.1});
  CHECK(scene.shapes[scene.bodies[1].shape].size == Vec3{0.75f, 0.75f, 0.75f});
  CHECK(scene.bodies[2].linear_velocity == Vec3{3, 0, 0});
  CHECK(scene.materials[scene.bodies[2].material].friction_combine == Combine::minimum);
  CHECK(scene.bodies[2].filter_mask == 5);
  CHECK(scene.bodies[1].filter_mask == 0xffffffffu);
}

TEST_CASE("malformed JSON: file, line and column")
{
  CHECK_THAT(scene_fault("{\n  \"tandem_scene\": 1,\n  \"name\": oops\n}"),
             ContainsSubstring("pile.json:3:11: malformed JSON: "));
  CHECK_THAT(scene_fault(""), ContainsSubstring("pile.json:1:1: malformed JSON"));
  CHECK_THAT(scene_fault("{\n  \"gravity\": [0, 1e400, 0]\n}"),
             ContainsSubstring("pile.json:2:22: malformed JSON: ") && ContainsSubstring("1e400"));
  CHECK_THAT(scene_fault("{\"tandem_scene\": 1"), ContainsSubstring("pile.json:1:19: malformed JSON"));
  CHECK_THAT(scene_fault("{\"a\": 1e999}"), ContainsSubstring("malformed JSON"));
  CHECK_THAT(scene_fault(with_body(R"("mass": NaN)")), ContainsSubstring("malformed JSON"));
  CHECK_THAT(scene_fault(std::string(50, '[')), ContainsSubstring("malformed JSON"));
  CHECK_THAT(scene_fault(with_body(R"("mass": 1, "mass": 2)")),
             ContainsSubstring("pile.json: the key \"mass\" stands twice"));
}

TEST_CASE("unknown keys and wrong types are refused with their place")
{
  CHECK_THAT(scene_fault(with_body(R"("mas": 1)")),
             ContainsSubstring("pile.json: bodies[1].mas: unknown key; known here: name, motion, shape"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "heavy")")),
             ContainsSubstring("pile.json: bodies[1].mass: is \"heavy\"; a number"));
  CHECK_THAT(scene_fault(with_body(R"("mass": null)")), ContainsSubstring("bodies[1].mass: is null; a number"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "nan")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "0xinf")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "0x1p+200")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "0x1.8p+1kg")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(scene_fault(with_body(R"("mass": "0x")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(scene_fault(with_body(R"("mass": 1e39)")),
             ContainsSubstring("bodies[1].mass: is 1e+39; no finite 32-bit float"));
  CHECK_THAT(scene_fault(with_body(R"("position": [1, 2])")),
             ContainsSubstring("bodies[1].position: is [1,2]; an array of 3 numbers"));
  CHECK_THAT(scene_fault(with_body(R"("position": [1, 2, true])")),
             ContainsSubstring("bodies[1].position[2]: is true; a number"));
  CHECK_THAT(scene_fault(with_body(R"("orientation": [0, 0, 0])")), ContainsSubstring("array of 4 numbers"));
  CHECK_THAT(scene_fault(with_body(R"("motion": "moving")")),
             ContainsSubstring("bodies[1].motion: is \"moving\"; one of fixed, kinematic, dynamic"));
  CHECK_THAT(scene_fault(with_body(R"("shape": -1)")), ContainsSubstring("bodies[1].shape: is -1; an integer from 0"));
  CHECK_THAT(scene_fault(with_body(R"("filter_mask": 4294967296)")), ContainsSubstring("bodies[1].filter_mask"));
  CHECK_THAT(scene_fault(with_body(R"("infinite_inertia": 1)")), ContainsSubstring("true or false"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": {}, "bodies": []})"),
             ContainsSubstring("shapes: is {}; an array"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": [], "bodies": [3]})"),
             ContainsSubstring("bodies[0]: is 3; an object"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": []})"), ContainsSubstring("\"bodies\" is missing"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 2, "shapes": [], "bodies": []})"),
             ContainsSubstring("version 1 is known"));
  CHECK_THAT(scene_fault(R"({"shapes": []})"), ContainsSubstring("this is not a Tandem scene"));
  CHECK_THAT(scene_fault("[]"), ContainsSubstring("an object is needed"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": [{"type": "torus"}], "bodies": []})"),
             ContainsSubstring("shapes[0].type: is \"torus\"; one of"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": [{"type": "sphere"}], "bodies": []})"),
             ContainsSubstring("\"radius\" is missing"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "shapes": [{"type": "box", "radius": 1}], "bodies": []})"),
             ContainsSubstring("shapes[0].radius: unknown key"));
  CHECK_THAT(
      scene_fault(
          R"({"tandem_scene": 1, "shapes": [{"type": "sphere", "radius": 1, "size": [1, 1, 1]}], "bodies": []})"),
      ContainsSubstring("exclude"));
}

namespace {

std::string with_shape(const std::string &shape, const std::string &body = "")
{
  return R"({"tandem_scene": 1, "shapes": [)" + shape + R"(], "bodies": [{)" + body + "}]}";
}

const std::string wedge =
    R"({"type": "hull", "points": [[0, 0, 0], [3, 0, 0], [0, 2, 0], [0, 0, 1], [0.1, 0.1, 0.1]]})";

} // namespace

TEST_CASE("capsules, cylinders, cones and hulls written by hand")
{
  auto shape = [](const std::string &text) {
    return parse_scene_json(with_shape(text, R"("motion": "fixed")"), "shapes").shapes[0];
  };
  CHECK(same_bits(shape(R"({"type": "capsule", "radius": 0.5, "half_height": 2})"), capsule_shape(0.5f, 2)));
  CHECK(same_bits(shape(R"({"half_height": 2, "type": "capsule", "radius_top": 0.25, "radius_bottom": 0.5})"),
                  {ShapeType::capsule, {0.5f, 2, 0.25f}}));
  CHECK(same_bits(shape(R"({"type": "cylinder", "radius": "0x1p-1", "half_height": 2})"), cylinder_shape(0.5f, 2)));
  CHECK(same_bits(shape(R"({"type": "cylinder", "radius_bottom": 0, "radius_top": 1, "half_height": 2})"),
                  {ShapeType::cylinder, {0, 2, 1}}));
  CHECK(same_bits(shape(R"({"type": "cylinder", "size": [1, 2, 3]})"), {ShapeType::cylinder, {1, 2, 3}}));
  CHECK(same_bits(shape(R"({"type": "cone", "radius": 0.5, "half_height": 2})"), cone_shape(0.5f, 2)));
  const Shape hull = shape(wedge);
  CHECK(hull.type == ShapeType::hull);
  CHECK(hull.hull->vertices ==
        std::vector<Vec3>{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}}); /* the fifth lies inside */
}

TEST_CASE("mistakes in shapes are named with their place")
{
  auto told = [](const std::string &shape) { return scene_fault(with_shape(shape)); };
  CHECK_THAT(told(R"({"type": "capsule", "half_height": 1})"),
             ContainsSubstring("shapes[0]: \"radius_bottom\" is missing"));
  CHECK_THAT(told(R"({"type": "capsule", "radius_bottom": 1, "half_height": 1})"),
             ContainsSubstring("\"radius_top\" is missing"));
  CHECK_THAT(told(R"({"type": "capsule", "radius": 1})"), ContainsSubstring("\"half_height\" is missing"));
  CHECK_THAT(told(R"({"type": "capsule", "radius": 1, "radius_top": 1, "half_height": 1})"),
             ContainsSubstring("exclude each other"));
  CHECK_THAT(told(R"({"type": "cylinder", "size": [1, 1, 1], "half_height": 1})"),
             ContainsSubstring("exclude each other"));
  CHECK_THAT(told(R"({"type": "cylinder", "height": 1, "radius": 1})"),
             ContainsSubstring("shapes[0].height: unknown key; known here: type, radius"));
  CHECK_THAT(told(R"({"type": "cone", "radius_top": 1, "half_height": 1})"),
             ContainsSubstring("shapes[0].radius_top: unknown key"));
  CHECK_THAT(told(R"({"type": "hull"})"), ContainsSubstring("shapes[0]: \"points\" is missing"));
  CHECK_THAT(told(R"({"type": "hull", "points": [[0, 0, 0], [1, 0]]})"),
             ContainsSubstring("shapes[0].points[1]: is [1,0]; an array of 3"));
  CHECK_THAT(told(R"({"type": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]})"),
             ContainsSubstring("pile.json: shapes[0].points: all 4 points lie in a plane"));
  CHECK_THAT(told(R"({"type": "capsule", "radius_bottom": 1, "radius_top": 4, "half_height": 1})"),
             ContainsSubstring("shape 0: one sphere of the capsule"));
}

TEST_CASE("a density takes mass, centre and axes from the shape")
{
  const std::string placed = R"("position": [1, 2, 3], "orientation": [0.6, 0, 0, 0.8], "shape_position": [0, 1, 0])";
  const Scene scene = parse_scene_json(with_shape(wedge, placed + R"(, "density": 500)"), "wedge");
  Scene expected = parse_scene_json(with_shape(wedge, placed + R"(, "motion": "fixed")"), "wedge");
  expected.bodies[0].type = BodyType::dynamic;
  expected.bodies[0].mass = 500; /* of a volume of 3 · 2 · 1 / 6 */
  take_mass_properties(expected, expected.bodies[0]);
  CHECK(scene.bodies[0].mass == Approx(500));
  CHECK(scene.bodies[0].position == expected.bodies[0].position);
  CHECK(scene.bodies[0].orientation == expected.bodies[0].orientation);
  CHECK(scene.bodies[0].shape_position == expected.bodies[0].shape_position);
  CHECK(scene.bodies[0].shape_orientation == expected.bodies[0].shape_orientation);
  CHECK(scene.bodies[0].shape_orientation != Quat{0, 0, 0, 1});
  check_same(scene, parse_scene_json(to_scene_json(scene), "again"));
  const Scene box = parse_scene_json(
      with_shape(R"({"type": "box", "half_extents": [1, 2, 3]})", R"("density": 10, "position": [0.1, 0, 0])"), "box");
  CHECK(box.bodies[0].mass == 480);
  CHECK(box.bodies[0].position == Point{0.1, 0, 0});

  auto told = [](const std::string &body, const std::string &shape = wedge) {
    return scene_fault(with_shape(shape, body));
  };
  CHECK_THAT(told(""), ContainsSubstring("body 0: inertia from shape and mass is about"));
  CHECK_THAT(told(R"("density": 1, "mass": 1)"),
             ContainsSubstring("bodies[0]: \"density\" and \"mass\" exclude each other"));
  CHECK_THAT(told(R"("density": 1, "inertia": [1, 1, 1])"), ContainsSubstring("\"density\" and \"inertia\" exclude"));
  CHECK_THAT(told(R"("density": 0)"), ContainsSubstring("bodies[0].density: is 0; a number above 0"));
  CHECK_THAT(told(R"("density": 1e38)", R"({"type": "sphere", "radius": 100})"),
             ContainsSubstring("body 0: mass is inf"));
  CHECK_THAT(told(R"("density": 1, "shape": 7)"), ContainsSubstring("shape 7 does not exist"));
  CHECK_THAT(told(R"("density": 1, "motion": "fixed")", R"({"type": "half_space"})"),
             ContainsSubstring("bodies[0].density: a half_space has no mass"));
  CHECK_THAT(told(R"("density": 1)", R"({"type": "sphere", "radius": -1})"),
             ContainsSubstring("shape 0: radius is -1"));
}

TEST_CASE("values that cannot be simulated are refused")
{
  CHECK(scene_fault(with_body("")).empty());
  CHECK_THAT(scene_fault(with_body(R"("mass": -3)")), ContainsSubstring("pile.json: body 1: mass is -3"));
  CHECK_THAT(scene_fault(with_body(R"("shape": 1)")), ContainsSubstring("shape 1 does not exist; the scene has 1"));
  CHECK_THAT(scene_fault(with_body(R"("orientation": [0, 0, 0, 0])")), ContainsSubstring("a quaternion of length 1"));
  CHECK_THAT(
      scene_fault(R"({"tandem_scene": 1, "shapes": [{"type": "box", "half_extents": [1, 0, 1]}], "bodies": []})"),
      ContainsSubstring("shape 0: a half extent is 0"));
  CHECK_THAT(scene_fault(R"({"tandem_scene": 1, "materials": [], "shapes": [], "bodies": []})"),
             ContainsSubstring("at least one"));
}

TEST_CASE("unwritable and unreadable places are named")
{
  CHECK_THROWS_WITH(write_scene_json(load_scene("pyramid:rows=1"), "no/such/folder/a.json"),
                    ContainsSubstring("no/such/folder/a.json: cannot write: No such file"));
  CHECK_THROWS_WITH(read_scene_json("/"), ContainsSubstring("/: cannot read: Is a directory"));
  Scene bad = load_scene("pyramid:rows=1");
  bad.bodies[0].name = "\xff";
  CHECK_THROWS_AS(to_scene_json(bad), InputError);
  bad.bodies[1].mass = -1;
  CHECK_THROWS_AS(to_scene_json(bad), InputError);
}

TEST_CASE("the examples of docs/scene-format.md are scenes")
{
  const std::string page = read_file(std::string(TANDEM_SOURCE_DIR) + "/docs/scene-format.md");
  int scenes = 0;
  for (size_t begin = page.find("```json\n"); begin != std::string::npos; begin = page.find("```json\n", begin + 1)) {
    const std::string example = page.substr(begin + 8, page.find("```\n", begin + 8) - begin - 8);
    if (example.find("tandem_scene") == std::string::npos) continue; /* a part of one */
    ++scenes;
    const Scene scene = parse_scene_json(example, "docs/scene-format.md");
    CHECK(warnings_of(scene, "").empty());
    for (const Body &body : scene.bodies) CHECK((body.type == BodyType::fixed || body.mass > 0.01f));
  }
  CHECK(scenes == 2);
}
