/* strict_test.cpp - values of wrong types, lengths and ranges in everything that physics reads from a glTF file: each
 * is refused in one line that names its place. Members that only concern rendering may have any value. */
#include "host/geometry/convex_hull.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using namespace tandem::gltf_text;
using Catch::Matchers::ContainsSubstring;

namespace {

void check_refused(const Parts &parts, const std::string &place)
{
  const std::string said = complaint(parts);
  INFO(gltf(parts) << "\n" << said);
  CHECK(said.find(temporary_path) == 0);
  CHECK_THAT(said, ContainsSubstring(place));
  CHECK(said.find('\n') == std::string::npos);
}

std::string replaced(std::string text, const std::string &part, const std::string &by)
{
  REQUIRE(text.find(part) != std::string::npos);
  return text.replace(text.find(part), part.size(), by);
}

const std::vector<std::string> no_numbers{R"("3")", R"("0x1p+1")", "true", "null", "{}", "[]", "1e39", "-1e300"};
const std::vector<std::string> no_indices{R"("0")",     "-1",         "-5",   "0.5",  "1e20", "99",
                                          "4294967295", "4294967296", "true", "null", "[0]",  "{}"};

/* Lists of n numbers, of which one or all are wrong. */
std::vector<std::string> no_vectors(size_t n)
{
  std::vector<std::string> wrong{R"("0 3 0")", "3", "true", "null", "{}", "[]"};
  const auto list = [&](size_t count, const std::string &last) {
    std::string text = "[";
    for (size_t i = 0; i + 1 < count; ++i) text += "0,";
    return text + last + "]";
  };
  for (const std::string &number : no_numbers) wrong.push_back(list(n, number));
  wrong.push_back(list(n - 1, "1"));
  wrong.push_back(list(n + 1, "1"));
  return wrong;
}

} // namespace

TEST_CASE("glTF, strictly: transforms of nodes")
{
  for (const auto &[key, n] : {std::pair{"translation", 3}, {"rotation", 4}, {"scale", 3}, {"matrix", 16}})
    for (const std::string &wrong : no_vectors(size_t(n))) {
      check_refused({.nodes = cup("", 0, std::string("\"") + key + "\":" + wrong + ",")},
                    std::string("node 'Cup': ") + key);
    }
  const std::string matrix = R"("matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],)";
  CHECK(complaint({.nodes = cup("", 0, matrix)}).empty());
  for (const char *other : {R"("translation":[0,0,0],)", R"("rotation":[0,0,0,1],)", R"("scale":[1,1,1],)"})
    check_refused({.nodes = cup("", 0, matrix + other)}, "node 'Cup': matrix and ");
  check_refused({.nodes = cup("", 0, replaced(matrix, "[1,0,0,0,", "[1,0,0,0.5,"))},
                "node 'Cup': matrix: the last row");
}

TEST_CASE("glTF, strictly: what nodes and scenes name")
{
  for (const std::string &wrong : no_indices) {
    check_refused({.nodes = cup("", 0, R"("children":[)" + wrong + "],") + ",{}"}, "node 'Cup': children[0]");
    check_refused({.nodes = cup("", 0, R"("mesh":)" + wrong + ","), .more = with_mesh(tip_points, tip_triangles)},
                  "node 'Cup': mesh");
    check_refused({.nodes = cup(""), .more = R"(,"scenes":[{"nodes":[0]}],"scene":)" + wrong}, ": scene: ");
    check_refused({.nodes = cup(""), .more = R"(,"scenes":[{"nodes":[)" + wrong + "]}]"}, ": scenes[0].nodes[0]: ");
    check_refused(
        {.nodes = cup(""),
         .more = R"(,"animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"path":"translation","node":)" +
                 wrong + "}}]}]"},
        ": animations[0].channels[0].target.node: ");
    for (const char *key : {"shape", "node", "mesh"})
      check_refused(
          {.nodes = cup_of(std::string("\"") + key + "\":" + wrong), .more = with_mesh(tip_points, tip_triangles)},
          "node 'Cup': ");
  }
  for (const char *wrong : {"1", R"("1")", "{}", "true", "null"}) {
    check_refused({.nodes = cup("", 0, std::string(R"("children":)") + wrong + ",")}, "node 'Cup': children");
    check_refused({.nodes = cup(""), .more = std::string(R"(,"scenes":)") + wrong}, ": scenes");
    check_refused({.nodes = cup(""), .more = std::string(R"(,"scenes":[{"nodes":)") + wrong + "}]"},
                  ": scenes[0].nodes");
  }
  check_refused({.nodes = cup("", 0, R"("tranlation":[0,3,0],)")}, "node 'Cup': tranlation: unknown key");
  check_refused({.nodes = R"({"name":7})"}, ": nodes[0].name: is 7; a string is needed");
  check_refused({.nodes = "7"}, ": nodes[0]: is 7; an object is needed");
  for (const char *wrong : {"null", "5", "[]"})
    check_refused({.nodes = std::string(R"({"name":"Cup","extensions":)") + wrong + "}"}, "an object is needed");
}

TEST_CASE("glTF, strictly: numbers of the two extensions")
{
  for (const std::string &wrong : no_numbers) {
    for (const char *key : {"mass", "gravityFactor"})
      check_refused({.nodes = cup(std::string("\"") + key + "\":" + wrong)}, std::string("node 'Cup': motion.") + key);
    check_refused({.nodes = cup(""), .shapes = R"({"type":"sphere","sphere":{"radius":)" + wrong + "}}"},
                  "extensions.KHR_implicit_shapes.shapes[0].sphere.radius");
    for (const char *key : {"height", "radiusTop", "radiusBottom"})
      check_refused(
          {.nodes = cup(""), .shapes = std::string(R"({"type":"cylinder","cylinder":{")") + key + "\":" + wrong + "}}"},
          std::string("cylinder.") + key);
    for (const char *key : {"staticFriction", "dynamicFriction", "restitution"})
      check_refused(
          {.nodes = cup(""), .document = std::string(R"("physicsMaterials":[{")") + key + "\":" + wrong + "}]"},
          std::string("physicsMaterials[0].") + key);
  }
  for (const char *key : {"centerOfMass", "inertiaDiagonal", "linearVelocity", "angularVelocity"})
    for (const std::string &wrong : no_vectors(3))
      check_refused({.nodes = cup(std::string("\"") + key + "\":" + wrong)}, std::string("node 'Cup': motion.") + key);
  for (const std::string &wrong : no_vectors(4))
    check_refused({.nodes = cup(R"("inertiaOrientation":)" + wrong)}, "node 'Cup': motion.inertiaOrientation");
  for (const std::string &wrong : no_vectors(3))
    check_refused({.nodes = cup(""), .shapes = R"({"type":"box","box":{"size":)" + wrong + "}}"}, "shapes[0].box.size");
  for (const char *wrong : {"1", R"("true")", "null", "[]"}) {
    check_refused({.nodes = cup(std::string(R"("isKinematic":)") + wrong)}, "node 'Cup': motion.isKinematic");
    check_refused({.nodes = cup_of(std::string(R"("mesh":0,"convexHull":)") + wrong),
                   .more = with_mesh(tip_points, tip_triangles)},
                  "collider.geometry.convexHull");
  }
}

TEST_CASE("glTF, strictly: accessors, views and buffers of meshes that a collider reads")
{
  const std::string mesh = with_mesh(tip_points, tip_triangles);
  const auto spoiled = [&](const std::string &part, const std::string &by) {
    check_refused({.nodes = cup_of(R"("mesh":0)"), .more = replaced(mesh, part, by)}, "node 'Cup': collider.geometry");
    /* The same damage in a mesh that only renders does not matter. */
    CHECK(complaint({.nodes = cup("", 0, R"("mesh":0,)"), .more = replaced(mesh, part, by)}).empty());
  };
  for (const std::string &wrong : no_indices) {
    spoiled(R"("POSITION":0)", R"("POSITION":)" + wrong);
    spoiled(R"("indices":1)", R"("indices":)" + wrong);
    spoiled(R"("accessors":[{"bufferView":0)", R"("accessors":[{"bufferView":)" + wrong);
    spoiled(R"("bufferViews":[{"buffer":0)", R"("bufferViews":[{"buffer":)" + wrong);
    spoiled(R"("componentType":5126)", R"("componentType":)" + wrong);
    spoiled(R"("count":4)", R"("count":)" + wrong);
  }
  for (const char *wrong : {R"("0")", "-4", "0.5", "4000000000", "true", "null"}) {
    spoiled(R"("componentType":5126)", std::string(R"("byteOffset":)") + wrong + R"(,"componentType":5126)");
    spoiled(R"("buffer":0,"byteLength":48)", std::string(R"("buffer":0,"byteLength":48,"byteOffset":)") + wrong);
    spoiled(R"("buffer":0,"byteLength":48)", std::string(R"("buffer":0,"byteLength":48,"byteStride":)") + wrong);
    spoiled(R"("buffers":[{"byteLength":72)", std::string(R"("buffers":[{"byteLength":)") + wrong);
    spoiled(R"("indices":1)", std::string(R"("indices":1,"mode":)") + wrong);
  }
  for (const char *wrong : {R"("VEC5")", "3", "null", R"("VEC2")", R"("MAT3")"})
    spoiled(R"("type":"VEC3")", std::string(R"("type":)") + wrong);
  for (const char *wrong : {"5120", "5122", "5124", "5126", "5130"})
    spoiled(R"("componentType":5123)", std::string(R"("componentType":)") + wrong);
  spoiled(R"("type":"SCALAR")", R"("type":"VEC2")");
  spoiled(R"("type":"VEC3")", R"("normalized":1,"type":"VEC3")");
  spoiled(R"("type":"VEC3")", R"("normalized":true,"type":"VEC3")");
  spoiled(R"("uri":"data:application/octet-stream;base64,)", R"("uri":"data:application/octet-stream;base64,?)");
  spoiled(R"("uri":"data:application/octet-stream;base64,)", R"("uri":"data:application/unknown;base64,)");
  spoiled(R"("uri":"data)", R"("uri":5,"name":"data)");
  spoiled(R"("primitives":[)", R"("weights":["1"],"primitives":[)");
  spoiled(R"("attributes":{"POSITION":0})", R"("attributes":[0])");
}

TEST_CASE("glTF: whole numbers for positions are read where the file says so")
{
  /* The corners of the tip in sixths of an unsigned byte each, which the scale makes metres again; 4 bytes a vertex. */
  const std::vector<uint8_t> packed{0, 0, 0, 0, 255, 0, 0, 0, 0, 170, 0, 0, 0, 0, 85, 0};
  std::string bytes = bytes_of(packed) + bytes_of(tip_triangles);
  const std::string mesh =
      R"(,"buffers":[{"byteLength":40,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
      R"("}],"bufferViews":[{"buffer":0,"byteLength":16,"byteStride":4},{"buffer":0,"byteOffset":16,"byteLength":24}],)"
      R"("accessors":[{"bufferView":0,"componentType":5121,"normalized":true,"type":"VEC3","count":4},)"
      R"({"bufferView":1,"componentType":5123,"type":"SCALAR","count":12}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
  const std::string quantized =
      R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
  const Scene scene = loaded({.nodes = cup_of(R"("mesh":0)", R"("scale":[3,3,3],)"), .more = mesh + quantized});
  REQUIRE(scene.shapes[0].type == ShapeType::hull);
  CHECK(scene.bodies[0].mass == Approx(1000));
  CHECK(near(rounded(scene.bodies[0].position), 0.75, 0.5, 0.25));
  const Scene plain = loaded({.nodes = cup_of(R"("mesh":0)", R"("scale":[0.5,0.5,0.5],)"),
                              .more = replaced(mesh, R"("normalized":true,)", "") + quantized});
  CHECK(plain.bodies[0].mass == Approx(1000 * std::pow(42.5, 3)));
  check_refused({.nodes = cup_of(R"("mesh":0)"), .more = mesh}, "whole numbers of KHR_mesh_quantization");
}

TEST_CASE("glTF: required extensions that cannot change the motion are passed over")
{
  const auto requires_it = [](const std::string &name) {
    return R"(,"extensionsUsed":[")" + name + R"("],"extensionsRequired":[")" + name + "\"]";
  };
  for (const char *name :
       {"KHR_lights_punctual", "KHR_materials_unlit", "KHR_materials_variants", "KHR_texture_basisu",
        "KHR_texture_transform", "EXT_texture_webp", "MSFT_texture_dds", "EXT_lights_image_based", "KHR_audio_emitter",
        "KHR_xmp_json_ld", "KHR_node_visibility", "MSFT_lod", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing", "KHR_mesh_quantization"}) {
    INFO(name);
    CHECK(complaint({.nodes = cup(""), .more = requires_it(name)}).empty());
  }
  for (const char *name : {"KHR_interactivity", "AGI_articulations", "ACME_wind", "", "KHR_lights",
                           "khr_lights_punctual", "MSFT_physics_bodies", "OMI_physics_joint"})
    check_refused({.nodes = cup(""), .more = requires_it(name)},
                  std::string("required extension ") + name + " is not supported yet");
  for (const char *wrong : {"[5]", R"("KHR_lights_punctual")", "{}", "[null]", "null"})
    for (const std::string list : {"extensionsRequired", "extensionsUsed"})
      check_refused({.nodes = cup(""), .more = ",\"" + list + "\":" + wrong}, list);
}

TEST_CASE("glTF: packed and instanced meshes are refused where a collider reads them, and nowhere else")
{
  const std::string mesh = with_mesh(tip_points, tip_triangles);
  const auto both = [&](const std::string &more, const std::string &said) {
    check_refused({.nodes = cup_of(R"("mesh":0)", R"("mesh":0,)"), .more = more}, said);
    CHECK(complaint({.nodes = cup("", 0, R"("mesh":0,)"), .more = more}).empty());
  };
  const std::string draco = replaced(
      mesh, R"("indices":1)",
      R"("indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})");
  both(replaced(draco, R"("accessors":[{"bufferView":0,)", R"("accessors":[{)"),
       "a mesh packed by KHR_draco_mesh_compression is not supported yet");
  CHECK(complaint({.nodes = cup_of(R"("mesh":0)"), .more = draco}).empty()); /* the plain numbers stand beside */
  for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    std::string packed =
        replaced(mesh, R"("buffers":[{)", R"("buffers":[{"extensions":{")" + name + R"(":{"fallback":true}},)");
    packed = replaced(packed, R"("bufferViews":[{)",
                      R"("bufferViews":[{"extensions":{")" + name +
                          R"(":{"buffer":0,"byteLength":4,"byteStride":12,"count":4,"mode":"ATTRIBUTES"}},)");
    both(packed, "a mesh packed by " + name + " is not supported yet");
  }
  const std::string crowd = R"(,{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}})";
  check_refused({.nodes = cup_of(R"("node":1)") + crowd, .more = mesh}, "many times over by EXT_mesh_gpu_instancing");
  CHECK(complaint({.nodes = cup("") + crowd, .more = mesh}).empty());
}

TEST_CASE("glTF: pictures and buffers that no collider reads may be missing, or anything")
{
  const std::string more =
      R"(,"images":[{"uri":"missing.png"},{"uri":"x.ktx2","mimeType":"image/ktx2"},{},{"uri":5},{"bufferView":7,)"
      R"("mimeType":"image/png"}],)"
      R"("textures":[{"source":77},5],"samplers":"none","materials":[{"pbrMetallicRoughness":7}],)"
      R"("cameras":[{"type":"fisheye"}],"skins":[{}],)"
      R"("buffers":[{"byteLength":4,"uri":"missing.bin"},{"byteLength":4,"uri":"../../missing.bin"}],)"
      R"("bufferViews":[{"buffer":9}],"accessors":[{"type":"X"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":9}]},{}])";
  CHECK(complaint({.nodes = cup("", 0, R"("mesh":0,"camera":3,)"), .more = more}).empty());
}

TEST_CASE("glTF: an animation that points at a body is one that names it")
{
  const auto pointing = [](const std::string &path) {
    return R"(,"animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"path":"pointer",)"
           R"("extensions":{"KHR_animation_pointer":{"pointer":")" +
           path + R"("}}}}]}])";
  };
  for (const char *path : {"/nodes/0/translation", "/nodes/0/rotation", "/nodes/0/scale"})
    check_refused({.nodes = cup(""), .more = pointing(path)},
                  "node 'Cup': animations[0].samplers: sampler 0 does not exist; the animation has 0");
  check_refused(
      {.nodes = cup(""), .more = pointing("/extensions/KHR_physics_rigid_bodies/physicsMaterials/0/staticFriction")},
      "is not supported yet");
  check_refused(
      {.nodes = cup(""), .more = pointing("/nodes/0/extensions/KHR_physics_rigid_bodies/motion/linearVelocity")},
      "is not supported yet");
  for (const char *path : {"/nodes/x/translation", "/nodes/9/translation", "/nodes/-1/translation"})
    check_refused({.nodes = cup(""), .more = pointing(path)}, "animations[0]");
  for (const char *path :
       {"/nodes/0/weights", "/materials/0/emissiveFactor", "/nodes/0/extensions/KHR_node_visibility/visible"})
    CHECK(complaint({.nodes = cup(""), .more = pointing(path)}).empty());
}

TEST_CASE("glTF: binary files whose chunks do not fit are refused")
{
  const auto number = [](size_t value) {
    std::string bytes(4, '\0');
    for (size_t k = 0; k < 4; ++k) bytes[k] = char(value >> 8 * k);
    return bytes;
  };
  const auto chunk = [&](const std::string &type, const std::string &bytes) {
    return number(bytes.size()) + type + bytes;
  };
  const auto said = [&](const std::string &chunks, size_t version, size_t length) {
    TemporaryFile file("glTF" + number(version) + number(length) + chunks);
    try {
      read_scene_gltf(file.path);
    } catch (const InputError &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string mesh = with_mesh(tip_points, tip_triangles);
  mesh.erase(mesh.find(R"(,"uri":)"), mesh.find(R"("}])") + 1 - mesh.find(R"(,"uri":)"));
  const std::string json = chunk("JSON", gltf({.nodes = cup_of(R"("mesh":0)"), .more = mesh}));
  const std::string buffer = chunk(std::string("BIN\0", 4), bytes_of(tip_points) + bytes_of(tip_triangles)),
                    whole = json + buffer;
  CHECK(said(whole, 2, 12 + whole.size()).empty());
  CHECK(said(whole + chunk("MORE", "abcd"), 2, 24 + whole.size())
            .empty()); /* chunks of unknown types are to be passed over */
  CHECK_THAT(said(json, 2, 12 + json.size()), ContainsSubstring("buffers[0]: has 0 bytes; it says 72"));
  CHECK_THAT(said(whole, 1, 12 + whole.size()), ContainsSubstring("not of version 2"));
  CHECK_THAT(said(whole, 2, 13 + whole.size()), ContainsSubstring("shorter than it says"));
  for (size_t cut : {1, 4, 72, 79})
    CHECK_THAT(said(whole.substr(0, whole.size() - cut), 2, 12 + whole.size() - cut),
               ContainsSubstring("a chunk ends behind the file"));
  CHECK_THAT(said(buffer + json, 2, 12 + whole.size()), ContainsSubstring("must be the JSON"));
  CHECK_THAT(said(json + json, 2, 12 + 2 * json.size()), ContainsSubstring("must be the JSON"));
  CHECK_THAT(said("", 2, 12), ContainsSubstring("ends within its first 20 bytes"));
}

TEST_CASE("glTF, strictly: what is not 0 but rounds to it does not stand for infinity")
{
  for (const char *small : {"1e-46", "-1e-46", "1e-300", "1e-400", "0.0000001e-9999"}) {
    const std::string number(small);
    check_refused({.nodes = cup("\"mass\":" + number)}, "node 'Cup': motion.mass: is ");
    check_refused({.nodes = cup("\"mass\":1,\"inertiaDiagonal\":[1,1," + number + "]")},
                  "node 'Cup': motion.inertiaDiagonal[2]: is ");
    CHECK(complaint({.nodes = cup("\"linearVelocity\":[0,1," + number + "]")}).empty());
    CHECK(complaint({.nodes = cup("", 0, "\"translation\":[0,1," + number + "],")}).empty());
  }
  for (const char *zero : {"0", "-0", "0.0", "0e-999", "-0.000E5"}) {
    const Scene scene = loaded({.nodes = cup(std::string("\"mass\":") + zero)});
    CHECK(scene.bodies[0].type == BodyType::kinematic);
  }
  CHECK(loaded({.nodes = cup("\"mass\":1e-35")}).bodies[0].type == BodyType::dynamic);
  check_refused({.nodes = collider(0, R"("name":"Cup","scale":[1e-200,1e-200,1e-200],)")},
                "node 'Cup': its scale is 0");
}

TEST_CASE("glTF, strictly: corners that make no whole triangles")
{
  const auto more = [](int mode, int count, bool indexed) {
    return R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) +
           (indexed ? R"(,"indices":1)" : "") +
           R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
           std::to_string(indexed ? 3 : count) + R"(},{"bufferView":1,"componentType":5121,"type":"SCALAR","count":)" +
           std::to_string(count) +
           R"(}],"bufferViews":[{"buffer":0,"byteLength":84},{"buffer":0,"byteOffset":84,"byteLength":8}],)"
           R"("buffers":[{"byteLength":92,"uri":")" +
           "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/" + /* 0 0 0, 1 0 0, 0
                                                                                                        0 -1 */
           "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/AAAAAAAAAAAAAAAA" + "AAECAAECAAA=" + R"("}])";
  };
  for (const bool indexed : {false, true}) {
    for (const int count : {1, 2, 4, 5, 7})
      check_refused({.nodes = cup_of(R"("mesh":0)"), .more = more(4, count, indexed)}, "a multiple of 3 is needed");
    for (const int mode : {5, 6})
      for (const int count : {1, 2})
        check_refused({.nodes = cup_of(R"("mesh":0)"), .more = more(mode, count, indexed)}, "at least 3 are needed");
    for (const int count : {3, 6})
      CHECK_THAT(complaint({.nodes = cup_of(R"("mesh":0)"), .more = more(4, count, indexed)}),
                 !ContainsSubstring("needed"));
  }
  const auto with_end = [&](const std::string &end) { return replaced(more(4, 3, false), "AAECAAECAAA=", end); };
  for (const char *end : {"AAECAAECAAA====", "AAECAAECAAA=x", "AAECAAECAAA=AAAA", "AAECAAEC=AA=", "AAEC!AECAAA="})
    check_refused({.nodes = cup_of(R"("mesh":0)"), .more = with_end(end)}, "no readable base64 data");
  for (const char *end : {"AAECAAECAAA=", "AAECAAECAAA"})
    CHECK_THAT(complaint({.nodes = cup_of(R"("mesh":0)"), .more = with_end(end)}), !ContainsSubstring("base64"));
}

TEST_CASE("glTF, strictly: the version, and the least that the file asks for")
{
  const auto said = [](const std::string &asset) {
    TemporaryFile file(replaced(gltf({.nodes = cup("")}), R"({"version":"2.0"})", asset));
    try {
      read_scene_gltf(file.path);
    } catch (const InputError &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char *least : {R"("3.0")", R"("2.1")", R"("1.0")", R"("2.")", R"("2.0x")", R"("two")", R"("")", "2", "2.0",
                            "null", "{}", "[]", "true"})
    CHECK_THAT(said(R"({"version":"2.0","minVersion":)" + std::string(least) + "}"),
               ContainsSubstring("asset.minVersion: is "));
  for (const char *version : {R"("3.0")", R"("2.")", R"("2.x")", R"("2")", "2.0", "null"})
    CHECK_THAT(said(R"({"version":)" + std::string(version) + "}"), ContainsSubstring("asset.version: is "));
  CHECK(said(R"({"version":"2.0","minVersion":"2.0"})").empty());
  CHECK(said(R"({"version":"2.1"})").empty());
}

TEST_CASE("glTF, strictly: a name that is printed is one printable line")
{
  const std::string node = replaced(cup(R"("mass":-1)"), "Cup", R"(a\nb\u0000c\u001b[31m\u0085\u2028d\u007f é)");
  const std::string said = complaint({.nodes = node});
  CHECK_THAT(said, ContainsSubstring(R"('a\nb\x00c\x1b[31m\x85\u2028d\x7f é')"));
}
