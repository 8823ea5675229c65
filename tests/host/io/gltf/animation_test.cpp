/* animation_test.cpp - bodies whose nodes are animated or skinned stand where the animation begins; animations and
 * skins of what is only seen change nothing. */
#include <limits>

#include "host/geometry/geometry.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using namespace tandem::gltf_text;
using Catch::Matchers::ContainsSubstring;

namespace {

/* The members of a file with one animation of one property of a node. */
std::string animated(int node, const std::string &path, const std::string &type, const std::vector<float> &keys,
                     const std::string &interpolation = "LINEAR")
{
  const std::string bytes = bytes_of(keys);
  const size_t count = keys.size() / (type == "VEC4" ? 4 : 3);
  return R"(,"animations":[{"samplers":[{"input":1,"output":0,"interpolation":")" + interpolation +
         R"("}],"channels":[{"sampler":0,"target":{"node":)" + std::to_string(node) + R"(,"path":")" + path +
         R"("}}]}],"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(bytes.size()) +
         R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":")" + type + R"(","count":)" +
         std::to_string(count) + "}]";
}

const std::vector<float> places{1, 2, 3, 4, 5, 6};
const std::string moving_cup = cup(R"("mass":2,"linearVelocity":[1,0,0],"angularVelocity":[0,1,0])");

} // namespace

TEST_CASE("glTF: an animated body is kinematic and stands at its first key")
{
  const Scene scene = loaded({.nodes = moving_cup, .more = animated(0, "translation", "VEC3", places)});
  REQUIRE(scene.bodies.size() == 1);
  const Body &body = scene.bodies[0];
  CHECK(body.type == BodyType::kinematic);
  CHECK(near(rounded(body.position), 1, 2, 3));
  CHECK((body.linear_velocity == Vec3{0, 0, 0} && body.angular_velocity == Vec3{0, 0, 0}));
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0] == temporary_path +
                              ": node 'Cup': moved by an animation of the file, which is not played; it is "
                              "a kinematic body that stands still");
  const Scene turned = loaded({.nodes = moving_cup, .more = animated(0, "rotation", "VEC4", {0, 0.6f, 0, 0.8f})});
  CHECK((rotation(turned.bodies[0].orientation) - rotation({0, 0.6f, 0, 0.8f})).norm() < 1e-6);
  const Scene large = loaded({.nodes = moving_cup, .more = animated(0, "scale", "VEC3", {2, 4, 6})});
  CHECK(near(large.shapes[0].size, 1, 2, 3));
  /* of a cubic spline a key is a tangent, the value and a tangent */
  const std::vector<float> spline{9, 9, 9, 1, 2, 3, 9, 9, 9};
  const Scene smooth = loaded({.nodes = moving_cup, .more = animated(0, "translation", "VEC3", spline, "CUBICSPLINE")});
  CHECK(near(rounded(smooth.bodies[0].position), 1, 2, 3));
}

TEST_CASE("glTF: whatever stands below an animated node is animated, down to the next motion")
{
  const std::string more = animated(0, "translation", "VEC3", places);
  const std::string above = R"({"children":[1]},)";
  const Scene body = loaded({.nodes = above + moving_cup, .more = more});
  CHECK(body.bodies[0].type == BodyType::kinematic);
  CHECK(near(rounded(body.bodies[0].position), 1, 2, 3));
  const Scene wall = loaded({.nodes = above + collider(0), .more = more});
  CHECK(wall.bodies[0].type == BodyType::kinematic);
  CHECK(near(rounded(wall.bodies[0].position), 1, 2, 3));
  CHECK_THAT(wall.notes.at(0), ContainsSubstring("node 1: moved by an animation"));
  const Scene two = loaded({.nodes = R"({"name":"Arm","children":[1],"extensions":{"KHR_physics_rigid_bodies":)"
                                     R"({"motion":{},"collider":{"geometry":{"shape":0}}}}},)" +
                                     moving_cup,
                            .more = more});
  CHECK((two.bodies[0].type == BodyType::kinematic && two.bodies[1].type == BodyType::dynamic));
  CHECK(two.notes.size() == 1);
}

TEST_CASE("glTF: a collider that an animation moves within its body stands at its first key")
{
  const Scene scene = loaded({.nodes = R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":)"
                                       R"({"motion":{"mass":1}}}},)" +
                                       collider(1),
                              .more = animated(1, "translation", "VEC3", places)});
  CHECK(scene.bodies[0].type == BodyType::dynamic);
  CHECK(near(rounded(scene.bodies[0].position), 1, 2, 3));
  REQUIRE(scene.notes.size() == 1);
  CHECK_THAT(scene.notes[0], ContainsSubstring("node 1: moved by an animation within its body"));
}

TEST_CASE("glTF: a skinned node with a motion is kinematic, and skins of what is only seen change nothing")
{
  const std::string more = R"(,"skins":[{"joints":[1]}],"meshes":[{}])";
  const Scene body =
      loaded({.nodes = cup(R"("linearVelocity":[1,0,0])", 0, R"("mesh":0,"skin":0,)") + ",{}", .more = more});
  CHECK((body.bodies[0].type == BodyType::kinematic && body.bodies[0].linear_velocity == Vec3{0, 0, 0}));
  CHECK_THAT(body.notes.at(0), ContainsSubstring("node 'Cup': moved by a skin of the file"));
  const Scene seen = loaded({.nodes = cup("") + R"(,{},{"mesh":0,"skin":0})", .more = more});
  CHECK((seen.bodies[0].type == BodyType::dynamic && seen.notes.empty()));
  /* bones with motions are a ragdoll */
  const Scene bone = loaded({.nodes = cup("") + R"(,{"mesh":0,"skin":0})",
                             .more = R"(,"skins":[{"joints":[0]}])" + std::string(R"(,"meshes":[{}])")});
  CHECK(bone.bodies[0].type == BodyType::dynamic);
}

TEST_CASE("glTF: animations of what is only seen are not read")
{
  const std::string missing = R"(,"animations":[{"samplers":[{"input":7,"output":8}],"channels":)"
                              R"([{"sampler":0,"target":{"node":1,"path":"translation"}}]}])";
  const Scene scene = loaded({.nodes = cup("") + ",{}", .more = missing});
  CHECK((scene.bodies[0].type == BodyType::dynamic && scene.notes.empty()));
}

TEST_CASE("glTF: damaged animations of bodies are refused")
{
  const std::string good = animated(0, "translation", "VEC3", places);
  const auto said = [&](const std::string &part, const std::string &by, const std::string &node = moving_cup) {
    std::string more = good;
    REQUIRE(more.find(part) != std::string::npos);
    return complaint({.nodes = node, .more = more.replace(more.find(part), part.size(), by)});
  };
  const std::string place = temporary_path + ": node 'Cup': animations[0].samplers";
  CHECK_THAT(said(R"("channels":[{"sampler":0)", R"("channels":[{"sampler":3)"),
             ContainsSubstring(place + ": sampler 3 does not exist; the animation has 1"));
  CHECK_THAT(said(R"("output":0)", R"("output":5)"),
             ContainsSubstring(place + "[0].output: accessor 5 of the animation does not exist; the file has 1"));
  CHECK_THAT(said("VEC3", "VEC4"), ContainsSubstring("lies outside its buffer"));
  CHECK_THAT(said("VEC3", "VEC2"), ContainsSubstring("output: keys of 3 numbers each are needed"));
  CHECK_THAT(said("LINEAR", "CUBIC"), ContainsSubstring("interpolation"));
  CHECK_THAT(said(R"("count":2)", R"("count":0)"), ContainsSubstring("accessor 0 of the animation, 0 elements"));
  CHECK_THAT(said(R"("path":"translation")", R"("path":"rotation")"),
             ContainsSubstring("output: keys of 4 numbers each are needed"));
  CHECK_THAT(said("LINEAR", "STEP", cup("", 0, R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],)")),
             ContainsSubstring("node 'Cup': is animated and has a matrix"));
  const std::string infinite = animated(0, "translation", "VEC3", {0, std::numeric_limits<float>::infinity(), 0});
  CHECK_THAT(complaint({.nodes = moving_cup, .more = infinite}), ContainsSubstring("the first key is not finite"));
}
