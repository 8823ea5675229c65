/* animation_test.cpp - the written file is valid glTF, by the rules of the specification and by an
 * independent reader, and holds the poses that were recorded. */
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>
#include <unistd.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "host/geometry/shape_mass.h"
#include "host/io/glb/animation.h"
#include "host/io/glb/geometry.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;
using json = nlohmann::json;

namespace {

/* Tests of one tree run at the same time, each in its own process. */
const std::string path =
    (std::filesystem::temp_directory_path() / ("tandem_animation_" + std::to_string(getpid()) + ".glb")).string();

struct RemoveAtEnd {
  ~RemoveAtEnd() { std::remove(path.c_str()); }
};

/* A pose that identifies its body and frame: the rotation about Y by an angle that passes half a turn. */
Vec3 position_of(size_t body, int frame) { return {float(body), 0.1f * float(frame), -float(body) * float(frame)}; }
Quat orientation_of(size_t body, int frame)
{
  double half_angle = 0.1 * double(body % 7) * frame + 0.05;
  double sign = frame % 3 == 1 ? -1 : 1; /* the same rotation, with the other sign */
  return {0, float(sign * std::sin(half_angle)), 0, float(sign * std::cos(half_angle))};
}

struct Frame {
  std::vector<Vec3> positions;
  std::vector<Quat> orientations;
};

Frame frame_of(const Scene &scene, int frame)
{
  Frame result;
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    bool moves = scene.bodies[i].type != BodyType::fixed;
    result.positions.push_back(moves ? position_of(i, frame) : rounded(scene.bodies[i].position));
    result.orientations.push_back(moves ? orientation_of(i, frame) : scene.bodies[i].orientation);
  }
  return result;
}

void record(const Scene &scene, int frames, uint32_t stride = 1)
{
  AnimationWriter writer(scene, path, stride);
  for (int frame = 0; frame < frames; ++frame) {
    Frame f = frame_of(scene, frame);
    writer.add_frame(frame / 60.0, f.positions, f.orientations);
  }
  writer.finish();
}

struct Glb {
  json document;
  std::string binary;
};

uint32_t word(const std::string &bytes, size_t at)
{
  uint32_t value;
  REQUIRE(at + 4 <= bytes.size());
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

/* The container: magic, version, whole length; chunks on multiples of 4 bytes. */
Glb read_container()
{
  std::ifstream stream(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  REQUIRE(word(bytes, 0) == 0x46546c67);
  REQUIRE(word(bytes, 4) == 2);
  REQUIRE(word(bytes, 8) == bytes.size());
  uint32_t json_length = word(bytes, 12);
  REQUIRE(json_length % 4 == 0);
  REQUIRE(word(bytes, 16) == 0x4e4f534a);
  Glb glb{json::parse(bytes.substr(20, json_length)), ""};
  if (20 + json_length == bytes.size()) return glb;
  uint32_t binary_length = word(bytes, 20 + json_length);
  REQUIRE(binary_length % 4 == 0);
  REQUIRE(word(bytes, 24 + json_length) == 0x004e4942);
  REQUIRE(28 + json_length + binary_length == bytes.size());
  glb.binary = bytes.substr(28 + json_length);
  return glb;
}

size_t component_bytes(const json &accessor) { return accessor["componentType"] == 5123 ? 2 : 4; }
size_t components(const json &accessor)
{
  const std::string type = accessor["type"];
  return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
}

std::vector<float> floats(const Glb &glb, size_t index)
{
  const json &accessor = glb.document["accessors"][index],
             &view = glb.document["bufferViews"][accessor["bufferView"].get<size_t>()];
  REQUIRE(accessor["componentType"] == 5126);
  std::vector<float> values(accessor["count"].get<size_t>() * components(accessor));
  std::memcpy(values.data(), glb.binary.data() + view.value("byteOffset", 0u) + accessor.value("byteOffset", 0u),
              4 * values.size());
  return values;
}

/* Views within the buffer, accessors within their views, aligned, no array empty, every number finite. */
void check_storage(const Glb &glb)
{
  const json &document = glb.document;
  REQUIRE(document["buffers"].size() == 1);
  CHECK(document["buffers"][0]["byteLength"] == glb.binary.size());
  for (const json &view : document["bufferViews"]) {
    CHECK(view["byteLength"].get<uint64_t>() > 0);
    CHECK(view["byteOffset"].get<uint64_t>() % 4 == 0);
    CHECK(view["byteOffset"].get<uint64_t>() + view["byteLength"].get<uint64_t>() <= glb.binary.size());
  }
  for (size_t i = 0; i < document["accessors"].size(); ++i) {
    const json &accessor = document["accessors"][i],
               &view = document["bufferViews"][accessor["bufferView"].get<size_t>()];
    uint64_t offset = accessor.value("byteOffset", uint64_t(0)),
             bytes = accessor["count"].get<uint64_t>() * components(accessor) * component_bytes(accessor);
    CHECK(accessor["count"].get<uint64_t>() > 0);
    CHECK(offset % component_bytes(accessor) == 0);
    CHECK((offset + view["byteOffset"].get<uint64_t>()) % component_bytes(accessor) == 0);
    CHECK(offset + bytes <= view["byteLength"].get<uint64_t>());
    if (accessor["componentType"] == 5126)
      for (float x : floats(glb, i)) REQUIRE(std::isfinite(x));
  }
  for (const auto &[key, value] : document.items())
    if (value.is_array()) CHECK(value.size() > 0);
}

void check_bounds(const Glb &glb, size_t index)
{
  const json &accessor = glb.document["accessors"][index];
  std::vector<float> values = floats(glb, index);
  size_t n = components(accessor);
  REQUIRE(accessor["min"].size() == n);
  REQUIRE(accessor["max"].size() == n);
  for (size_t c = 0; c < n; ++c) {
    float low = values[c], high = values[c];
    for (size_t i = c; i < values.size(); i += n) low = std::min(low, values[i]), high = std::max(high, values[i]);
    CHECK(accessor["min"][c].get<float>() == low);
    CHECK(accessor["max"][c].get<float>() == high);
  }
}

void check_animation(const Glb &glb, size_t frames)
{
  const json &animation = glb.document["animations"][0];
  REQUIRE(animation["samplers"].size() == animation["channels"].size());
  std::set<std::pair<size_t, std::string>> targets;
  for (const json &channel : animation["channels"]) {
    const json &sampler = animation["samplers"][channel["sampler"].get<size_t>()];
    bool rotation = channel["target"]["path"] == "rotation";
    const json &output = glb.document["accessors"][sampler["output"].get<size_t>()];
    CHECK(sampler["interpolation"] == "LINEAR");
    CHECK(output["type"] == (rotation ? "VEC4" : "VEC3"));
    CHECK(output["count"] == frames);
    CHECK(glb.document["accessors"][sampler["input"].get<size_t>()]["count"] == frames);
    CHECK(targets.emplace(channel["target"]["node"].get<size_t>(), channel["target"]["path"]).second);
  }
}

tinygltf::Model reread()
{
  tinygltf::TinyGLTF parser;
  tinygltf::Model model;
  std::string error, warning;
  bool read = parser.LoadBinaryFromFile(&model, &error, &warning, path);
  INFO(error << warning);
  REQUIRE(read);
  CHECK(warning.empty());
  return model;
}

} // namespace

TEST_CASE("a recorded animation is valid and holds the poses")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("mixed:n=30");
  scene.bodies[6].name = "a \"quoted\" name";
  const int frames = 13;
  record(scene, frames);
  Glb glb = read_container();
  check_storage(glb);
  check_animation(glb, frames);
  const json &document = glb.document;
  CHECK(document["nodes"].size() == scene.bodies.size());
  CHECK(document["scenes"][0]["nodes"].size() == scene.bodies.size());
  CHECK(document["animations"][0]["channels"].size() == 2 * 30);
  CHECK(document["nodes"][6]["name"] == "a \"quoted\" name");
  CHECK(document["nodes"][7]["name"] == "body 7");
  for (const json &mesh : document["meshes"]) check_bounds(glb, mesh["primitives"][0]["attributes"]["POSITION"]);
  check_bounds(glb, document["animations"][0]["samplers"][0]["input"]);

  tinygltf::Model model = reread();
  CHECK(model.materials.size() == palette.size());
  for (const json &channel : document["animations"][0]["channels"]) {
    size_t body = channel["target"]["node"];
    std::vector<float> values =
        floats(glb, document["animations"][0]["samplers"][channel["sampler"].get<size_t>()]["output"]);
    for (int frame = 0; frame < frames; ++frame) {
      if (channel["target"]["path"] == "translation") {
        CHECK(std::memcmp(&values[size_t(3 * frame)], position_of(body, frame).data(), 12) == 0);
        continue;
      }
      Quat expected = orientation_of(body, frame);
      double same = 0, before = 0;
      for (size_t c = 0; c < 4; ++c) {
        same += double(values[size_t(4 * frame) + c]) * expected[c];
        if (frame > 0) before += double(values[size_t(4 * frame) + c]) * values[size_t(4 * frame - 4) + c];
      }
      CHECK(std::abs(same) == Approx(1).epsilon(1e-6)); /* the recorded rotation */
      if (frame > 0) CHECK(before > 0);                 /* and the short way from the one before */
    }
  }
  const std::vector<double> &start = model.nodes[9].translation;
  CHECK((start == std::vector<double>{9, 0, 0}));
}

TEST_CASE("nodes have their body's size and colours tell bodies apart")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("mixed:n=40");
  record(scene, 2);
  tinygltf::Model model = reread();
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Shape &shape = scene.shapes[scene.bodies[i].shape];
    if (shape.type == ShapeType::half_space) continue;
    for (size_t axis = 0; axis < 3; ++axis) CHECK(model.nodes[i].scale[axis] == Approx(shape.size[axis]));
  }
  auto color = [&](size_t body) { return model.meshes[size_t(model.nodes[body].mesh)].primitives[0].material; };
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    for (size_t j = 0; j < scene.bodies.size(); ++j) {
      bool moves = scene.bodies[i].type == BodyType::dynamic, other_moves = scene.bodies[j].type == BodyType::dynamic;
      bool alike = moves == other_moves && (!moves || scene.bodies[i].material == scene.bodies[j].material);
      CHECK((color(i) == color(j)) == alike);
    }
}

namespace {

double volume_of(const DisplayMesh &mesh)
{
  double volume = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    Eigen::Vector3d corner[3];
    for (size_t c = 0; c < 3; ++c)
      corner[c] = Eigen::Vector3f(mesh.positions[mesh.indices[i + c]].data()).cast<double>();
    volume += corner[0].dot(corner[1].cross(corner[2])) / 6;
  }
  return volume;
}

void check_faces_outwards(const DisplayMesh &mesh)
{
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    Eigen::Vector3d corner[3];
    for (size_t c = 0; c < 3; ++c)
      corner[c] = Eigen::Vector3f(mesh.positions[mesh.indices[i + c]].data()).cast<double>();
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    CHECK(normal.norm() > 1e-4);
    for (size_t c = 0; c < 3; ++c)
      CHECK(normal.dot(Eigen::Vector3f(mesh.normals[mesh.indices[i + c]].data()).cast<double>()) > 0);
  }
  for (const Vec3 &normal : mesh.normals) CHECK(Eigen::Vector3f(normal.data()).norm() == Approx(1));
}

/* Each edge between two places is run along once in each direction. Places that differ by roundings of a sine are
 * one. */
void check_closed(const DisplayMesh &mesh)
{
  auto place = [&](uint32_t vertex) {
    std::array<long, 3> rounded;
    for (size_t axis = 0; axis < 3; ++axis) rounded[axis] = std::lround(double(mesh.positions[vertex][axis]) * 1e5);
    return rounded;
  };
  std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> edges;
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    for (size_t c = 0; c < 3; ++c) ++edges[{place(mesh.indices[i + c]), place(mesh.indices[i + (c + 1) % 3])}];
  for (const auto &[edge, count] : edges) {
    CHECK(count == 1);
    CHECK(edges.count({edge.second, edge.first}) == 1);
  }
}

const std::vector<Vec3> wedge_points{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {3, 2, 0}, {0, 0, 1}, {3, 0, 1}};

} // namespace

TEST_CASE("meshes are closed, face outwards and have the right volume")
{
  const Shape round[] = {capsule_shape(0.5f, 1),
                         {ShapeType::capsule, {0.3f, 0.4f, 0.9f}},
                         {ShapeType::capsule, {0.9f, 0.4f, 0.3f}},
                         cylinder_shape(0.5f, 1),
                         {ShapeType::cylinder, {0.3f, 0.4f, 0.9f}},
                         cone_shape(0.6f, 0.5f),
                         {ShapeType::cylinder, {0, 1, 0.5f}}};
  for (const Shape &shape : round) {
    INFO("shape type " << int(shape.type) << " size " << shape.size[0] << " " << shape.size[1] << " " << shape.size[2]);
    const DisplayMesh mesh = display_mesh(shape);
    check_faces_outwards(mesh);
    check_closed(mesh);
    const double volume = volume_of(mesh), whole = mass_properties_of(shape).mass;
    CHECK(volume < whole); /* corners lie on the surface */
    CHECK(volume > 0.96 * whole);
  }
  const Shape wedge = hull_shape(wedge_points, "wedge");
  for (const Shape &shape : {box_shape(1, 1, 1), wedge}) {
    check_faces_outwards(display_mesh(shape));
    check_closed(display_mesh(shape));
    CHECK(volume_of(display_mesh(shape)) == Approx(mass_properties_of(shape).mass));
  }
  CHECK(display_mesh(wedge).positions.size() ==
        3 + 3 + 4 + 4 + 4); /* each face has corners, and a normal, of its own */
  check_faces_outwards(display_mesh(sphere_shape(1)));
  check_closed(display_mesh(sphere_shape(1)));
  CHECK(volume_of(display_mesh(sphere_shape(1))) == Approx(4.0 / 3.0 * M_PI).epsilon(0.04));
  for (const Vec3 &normal : display_mesh(half_space_shape()).normals) CHECK(normal == Vec3{0, 1, 0});
}

TEST_CASE("outlines lie on their shape and reach its ends")
{
  auto bounds = [](const Shape &shape) { return bounds_of(outline_points(shape)); };
  CHECK(bounds(sphere_shape(2)).upper[1] == 2);
  CHECK(bounds(box_shape(1, 2, 3)).lower == Vec3{-1, -2, -3});
  CHECK(bounds({ShapeType::capsule, {0.5f, 1, 0.25f}}).upper[1] == 1.25f);
  CHECK(bounds({ShapeType::capsule, {0.5f, 1, 0.25f}}).lower[1] == -1.5f);
  CHECK(bounds(cone_shape(0.5f, 1)).upper == Vec3{0.5f, 1, 0.5f});
  CHECK(outline_points(hull_shape(wedge_points, "wedge")).size() == 6);
  CHECK(outline_points(half_space_shape()).empty());
}

TEST_CASE("a shape with a pose in its body is drawn there")
{
  RemoveAtEnd remove;
  Scene scene;
  scene.shapes = {cone_shape(0.5f, 1), hull_shape(wedge_points, "wedge"), capsule_shape(0.2f, 0.3f),
                  cone_shape(0.5f, 1), cone_shape(0.5f, 2)};
  scene.materials.resize(2); /* coloured by material: bodies alike share a mesh */
  scene.bodies.resize(6);
  for (uint32_t i = 0; i < 5; ++i) scene.bodies[i].shape = i;
  scene.bodies[5].shape = 1;
  for (Body &body : scene.bodies) take_mass_properties(scene, body);
  record(scene, 3);
  Glb glb = read_container();
  check_storage(glb);
  check_animation(glb, 3);
  const tinygltf::Model model = reread();
  REQUIRE(model.nodes.size() == 6 + 5); /* the capsule's frame is its body's */
  CHECK(model.scenes[0].nodes.size() == 6);
  CHECK(model.meshes.size() == 4); /* equal cones share one, as the hull's two bodies do; another cone has its own */
  std::set<int> drawn;
  for (size_t i = 0; i < 6; ++i) {
    const Body &body = scene.bodies[i];
    const tinygltf::Node &node = model.nodes[i];
    if (i == 2) {
      CHECK(node.children.empty());
      drawn.insert(node.mesh);
      continue;
    }
    CHECK(node.mesh == -1);
    REQUIRE(node.children.size() == 1);
    const tinygltf::Node &shape = model.nodes[size_t(node.children[0])];
    drawn.insert(shape.mesh);
    CHECK(shape.scale == std::vector<double>{1, 1, 1});
    for (size_t axis = 0; axis < 3; ++axis) CHECK(float(shape.translation[axis]) == body.shape_position[axis]);
    for (size_t k = 0; k < 4; ++k) CHECK(shape.rotation[k] == Approx(body.shape_orientation[k]));
  }
  CHECK(drawn.size() == 4);
}

TEST_CASE("a hull with more corners than 16 bits count has wider indices")
{
  RemoveAtEnd remove;
  Random random(3);
  std::vector<Vec3> points;
  for (int i = 0; i < 14000; ++i) { /* three corners each of some 28,000 faces */
    double p[3], length = 0;
    for (double &x : p) x = random.uniform(-1, 1), length += x * x;
    points.push_back(
        {float(p[0] / std::sqrt(length)), float(p[1] / std::sqrt(length)), float(p[2] / std::sqrt(length))});
  }
  Scene scene;
  scene.shapes = {hull_shape(points, "ball"), box_shape(1, 1, 1)};
  scene.bodies.resize(2);
  scene.bodies[1].shape = 1;
  REQUIRE(display_mesh(scene.shapes[0]).positions.size() > 65535);
  record(scene, 2);
  const tinygltf::Model model = reread();
  auto indices_of = [&](size_t node) {
    return model.accessors[size_t(model.meshes[size_t(model.nodes[node].mesh)].primitives[0].indices)];
  };
  CHECK(indices_of(0).componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  CHECK(indices_of(1).componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

TEST_CASE("the stride keeps every n-th frame")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("pyramid:rows=2");
  record(scene, 10, 4);
  Glb glb = read_container();
  check_animation(glb, 3);
  std::vector<float> times = floats(glb, glb.document["animations"][0]["samplers"][0]["input"]);
  CHECK(times == std::vector<float>{0, float(4 / 60.0), float(8 / 60.0)});
}

TEST_CASE("what never moves has no channels, and nothing at all is still a file")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("pyramid:rows=3");
  Frame still;
  for (const Body &body : scene.bodies)
    still.positions.push_back(rounded(body.position)), still.orientations.push_back(body.orientation);
  {
    AnimationWriter writer(scene, path);
    writer.add_frame(0, still.positions, still.orientations);
    still.positions[2][1] += 1;
    writer.add_frame(1, still.positions, still.orientations);
    writer.finish();
  }
  Glb glb = read_container();
  check_storage(glb);
  CHECK(glb.document["animations"][0]["channels"].size() == 2);
  CHECK(glb.document["animations"][0]["channels"][0]["target"]["node"] == 2);
  {
    AnimationWriter(scene, path).finish();
  }
  glb = read_container();
  check_storage(glb);
  CHECK_FALSE(glb.document.contains("animations"));
  reread();
  {
    AnimationWriter(Scene{}, path).finish();
  }
  CHECK(read_container().document.size() == 1);
}

TEST_CASE("a pose that is not finite repeats the last one")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("pyramid:rows=1");
  {
    AnimationWriter writer(scene, path);
    for (int frame = 0; frame < 4; ++frame) {
      Frame f = frame_of(scene, frame);
      if (frame == 2) f.positions[1][0] = std::numeric_limits<float>::quiet_NaN();
      writer.add_frame(frame, f.positions, f.orientations);
    }
    writer.finish();
  }
  Glb glb = read_container();
  check_storage(glb);
  std::vector<float> heights = floats(glb, glb.document["animations"][0]["samplers"][0]["output"]);
  CHECK(heights[3 * 2 + 1] == heights[3 * 1 + 1]);
  CHECK(heights[3 * 3 + 1] == position_of(1, 3)[1]);
}

TEST_CASE("more bodies than 16 bits count")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("spheres:n=70000");
  record(scene, 2);
  tinygltf::Model model = reread();
  CHECK(model.nodes.size() == 70001);
  CHECK(model.meshes.size() < 10);
  CHECK(model.animations[0].channels.size() == 140000);
  std::vector<float> last = floats(read_container(), size_t(model.animations[0].samplers[139998].output));
  CHECK(last[3] == position_of(70000, 1)[0]);
  CHECK(last[4] == position_of(70000, 1)[1]);
}

TEST_CASE("an animation that is not finished leaves what stood there, and nothing else")
{
  RemoveAtEnd remove;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const auto like_it = [&] {
    return std::count_if(std::filesystem::directory_iterator(folder), {},
                         [](const auto &entry) { return entry.path().string().starts_with(path); });
  };
  const Scene scene = load_scene("pyramid:rows=1");
  std::ofstream(path) << "kept";
  {
    AnimationWriter writer(scene, path);
    const Frame f = frame_of(scene, 0);
    writer.add_frame(0, f.positions, f.orientations);
  }
  std::string text;
  std::ifstream(path) >> text;
  CHECK(text == "kept");
  CHECK(like_it() == 1);
  AnimationWriter writer(scene, path);
  writer.finish();
  std::ifstream(path) >> text;
  CHECK(text.substr(0, 4) == "glTF");
  CHECK(like_it() == 1);
}

TEST_CASE("mistakes are told at once")
{
  RemoveAtEnd remove;
  Scene scene = load_scene("pyramid:rows=1");
  CHECK_THROWS_WITH(AnimationWriter(scene, "no/such/folder/a.glb"),
                    ContainsSubstring("no/such/folder/a.glb: cannot write: No such file"));
  CHECK_THROWS_WITH(AnimationWriter(scene, "movie.mp4"),
                    ContainsSubstring("movie.mp4: an animation is written as .glb"));
  CHECK_THROWS_AS(AnimationWriter(scene, path, 0), InputError);
  {
    AnimationWriter writer(scene, path);
    Frame f = frame_of(scene, 0);
    writer.add_frame(0, f.positions, f.orientations);
    CHECK_THROWS_WITH(writer.add_frame(0, f.positions, f.orientations), ContainsSubstring("does not come after"));
    f.positions.pop_back();
    CHECK_THROWS_WITH(writer.add_frame(1, f.positions, f.orientations), ContainsSubstring("the scene has 2 bodies"));
  }
  CHECK_FALSE(std::filesystem::exists(path)); /* never finished */
}
