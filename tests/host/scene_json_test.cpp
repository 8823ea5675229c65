/* scene_json_test.cpp - a written scene reads back to the same bits; every mistake in a file is named with its place. */
#include "host/random.h"
#include "host/scene_catalog.h"
#include "host/scene_json.h"
#include "tests/catch.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIR) + "/tests/scenes/";

std::string complaint(const std::string &text)
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
  return R"({"tandem_scene": 1, "shapes": [{"type": "box", "half_extents": [1, 1, 1]}], "bodies": [{"name": "first"}, {)" +
         fields + "}]}";
}

template <typename T> bool same_bits(const T &a, const T &b) { return std::memcmp(&a, &b, sizeof(T)) == 0; }

bool same_bits(const Material &a, const Material &b)
{
  return a.name == b.name && same_bits(a.static_friction, b.static_friction) &&
         same_bits(a.dynamic_friction, b.dynamic_friction) && same_bits(a.restitution, b.restitution) &&
         same_bits(a.rolling_friction, b.rolling_friction) && same_bits(a.spinning_friction, b.spinning_friction) &&
         a.friction_combine == b.friction_combine && a.restitution_combine == b.restitution_combine;
}

bool same_bits(const Body &a, const Body &b)
{
  return a.name == b.name && a.motion == b.motion && a.shape == b.shape && a.material == b.material &&
         same_bits(a.position, b.position) && same_bits(a.orientation, b.orientation) &&
         same_bits(a.linear_velocity, b.linear_velocity) && same_bits(a.angular_velocity, b.angular_velocity) &&
         same_bits(a.mass, b.mass) && same_bits(a.inertia, b.inertia) && a.infinite_inertia == b.infinite_inertia &&
         same_bits(a.gravity_factor, b.gravity_factor) && same_bits(a.linear_damping, b.linear_damping) &&
         same_bits(a.angular_damping, b.angular_damping) && a.filter_group == b.filter_group &&
         a.filter_mask == b.filter_mask;
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

Scene scene_of_odd_numbers()
{
  Random random(2026);
  Scene scene;
  scene.name = "odd \"quoted\" \\ \n ünï";
  scene.gravity = any_vector(random);
  scene.shapes = {sphere_shape(0.1f),
                  box_shape(0x1p-100f, 3.3333333f, 0x1.fffffep+126f),
                  half_space_shape(),
                  {ShapeType::sphere, {1, 2, 3}}};
  scene.materials.resize(2);
  scene.materials[1] = {"glue", 0x1p-149f, 1e30f, 0.3f, Combine::multiply, Combine::average, 0x1p-140f, 0.1f};
  for (int i = 0; i < 200; ++i) {
    Body body;
    body.name = i % 2 ? "b" + std::to_string(i) : "";
    body.motion = Motion(i % 3);
    body.shape = uint32_t(i) % 2 ? 0 : 3;
    body.material = uint32_t(i) % 2;
    body.position = any_vector(random);
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
  Scene scene = load_scene(scenes + "three_bodies.json");
  CHECK(scene.name == "three bodies");
  CHECK(scene.gravity == Vec3{0, -9.81f, 0});
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.bodies[0].motion == Motion::fixed);
  CHECK(scene.shapes[scene.bodies[0].shape].type == ShapeType::half_space);
  CHECK(scene.bodies[1].mass == 2.5f);
  CHECK(scene.bodies[1].position == Vec3{0, 3, -0.1f});
  CHECK(scene.shapes[scene.bodies[1].shape].size == Vec3{0.75f, 0.75f, 0.75f});
  CHECK(scene.bodies[2].linear_velocity == Vec3{3, 0, 0});
  CHECK(scene.materials[scene.bodies[2].material].friction_combine == Combine::minimum);
  CHECK(scene.bodies[2].filter_mask == 5);
  CHECK(scene.bodies[1].filter_mask == 0xffffffffu);
}

TEST_CASE("malformed JSON: file, line and column")
{
  CHECK_THAT(complaint("{\n  \"tandem_scene\": 1,\n  \"name\": oops\n}"), ContainsSubstring("pile.json:3:11: malformed JSON: "));
  CHECK_THAT(complaint(""), ContainsSubstring("pile.json:1:1: malformed JSON"));
  CHECK_THAT(complaint("{\"tandem_scene\": 1"), ContainsSubstring("pile.json:1:19: malformed JSON"));
  CHECK_THAT(complaint("{\"a\": 1e999}"), ContainsSubstring("malformed JSON"));
  CHECK_THAT(complaint(with_body(R"("mass": NaN)")), ContainsSubstring("malformed JSON"));
  CHECK_THAT(complaint(std::string(100000, '[')), ContainsSubstring("malformed JSON"));
  CHECK_THAT(complaint(with_body(R"("mass": 1, "mass": 2)")), ContainsSubstring("pile.json: the key \"mass\" stands twice"));
}

TEST_CASE("unknown keys and wrong types are refused with their place")
{
  CHECK_THAT(complaint(with_body(R"("mas": 1)")),
             ContainsSubstring("pile.json: bodies[1].mas: unknown key; known here: name, motion, shape"));
  CHECK_THAT(complaint(with_body(R"("mass": "heavy")")), ContainsSubstring("pile.json: bodies[1].mass: is \"heavy\"; a number"));
  CHECK_THAT(complaint(with_body(R"("mass": null)")), ContainsSubstring("bodies[1].mass: is null; a number"));
  CHECK_THAT(complaint(with_body(R"("mass": "nan")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(complaint(with_body(R"("mass": "0xinf")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(complaint(with_body(R"("mass": "0x1p+200")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(complaint(with_body(R"("mass": "0x1.8p+1kg")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(complaint(with_body(R"("mass": "0x")")), ContainsSubstring("bodies[1].mass"));
  CHECK_THAT(complaint(with_body(R"("mass": 1e39)")), ContainsSubstring("bodies[1].mass: is 1e+39; no finite 32-bit float"));
  CHECK_THAT(complaint(with_body(R"("position": [1, 2])")),
             ContainsSubstring("bodies[1].position: is [1,2]; an array of 3 numbers"));
  CHECK_THAT(complaint(with_body(R"("position": [1, 2, true])")), ContainsSubstring("bodies[1].position[2]: is true; a number"));
  CHECK_THAT(complaint(with_body(R"("orientation": [0, 0, 0])")), ContainsSubstring("array of 4 numbers"));
  CHECK_THAT(complaint(with_body(R"("motion": "moving")")),
             ContainsSubstring("bodies[1].motion: is \"moving\"; one of fixed, kinematic, dynamic"));
  CHECK_THAT(complaint(with_body(R"("shape": -1)")), ContainsSubstring("bodies[1].shape: is -1; an integer from 0"));
  CHECK_THAT(complaint(with_body(R"("filter_mask": 4294967296)")), ContainsSubstring("bodies[1].filter_mask"));
  CHECK_THAT(complaint(with_body(R"("infinite_inertia": 1)")), ContainsSubstring("true or false"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": {}, "bodies": []})"), ContainsSubstring("shapes: is {}; an array"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": [], "bodies": [3]})"), ContainsSubstring("bodies[0]: is 3; an object"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": []})"), ContainsSubstring("\"bodies\" is missing"));
  CHECK_THAT(complaint(R"({"tandem_scene": 2, "shapes": [], "bodies": []})"), ContainsSubstring("version 1 is known"));
  CHECK_THAT(complaint(R"({"shapes": []})"), ContainsSubstring("this is not a Tandem scene"));
  CHECK_THAT(complaint("[]"), ContainsSubstring("an object is needed"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": [{"type": "capsule"}], "bodies": []})"),
             ContainsSubstring("shapes[0].type: is \"capsule\"; one of"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": [{"type": "sphere"}], "bodies": []})"),
             ContainsSubstring("\"radius\" is missing"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": [{"type": "box", "radius": 1}], "bodies": []})"),
             ContainsSubstring("shapes[0].radius: unknown key"));
  CHECK_THAT(
      complaint(R"({"tandem_scene": 1, "shapes": [{"type": "sphere", "radius": 1, "size": [1, 1, 1]}], "bodies": []})"),
      ContainsSubstring("exclude"));
}

TEST_CASE("values that cannot be simulated are refused")
{
  CHECK(complaint(with_body("")).empty());
  CHECK_THAT(complaint(with_body(R"("mass": -3)")), ContainsSubstring("pile.json: body 1: mass is -3"));
  CHECK_THAT(complaint(with_body(R"("shape": 1)")), ContainsSubstring("shape 1 does not exist; the scene has 1"));
  CHECK_THAT(complaint(with_body(R"("orientation": [0, 0, 0, 0])")), ContainsSubstring("a quaternion of length 1"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "shapes": [{"type": "box", "half_extents": [1, 0, 1]}], "bodies": []})"),
             ContainsSubstring("shape 0: a half extent is 0"));
  CHECK_THAT(complaint(R"({"tandem_scene": 1, "materials": [], "shapes": [], "bodies": []})"),
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
