/* scene_gltf_test.cpp - glTF physics: node transforms against Eigen, filters against the extension's sentence,
 * and for everything the pipeline does not know, a refusal with the node's name. */
#include "host/scene_catalog.h"
#include "host/scene_gltf.h"
#include "tests/catch.h"

#include <Eigen/Dense>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <unistd.h>

using namespace tandem;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIR) + "/tests/scenes/";

/* Tests of one tree run at the same time, each in its own process. */
const std::string temporary_path =
    (fs::temp_directory_path() / ("tandem_scene_" + std::to_string(getpid()) + ".gltf")).string();

/* A .gltf file that lives as long as the object. */
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string &text, const std::string &name = temporary_path) : path(name)
  {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::remove(path.c_str()); }
};

struct Parts {
  std::string nodes; /* JSON array items */
  std::string shapes =
      R"({"type":"box","box":{}},{"type":"sphere","sphere":{}},{"type":"plane"})"; /* 0 box, 1 sphere, 2 plane */
  std::string document = ""; /* members of the rigid-body extension */
  std::string more = "";     /* further members of the file */
};

std::string gltf(const Parts &parts)
{
  return R"({"asset":{"version":"2.0"},"nodes":[)" + parts.nodes +
         R"(],"extensions":{"KHR_implicit_shapes":{"shapes":[)" + parts.shapes + R"(]},"KHR_physics_rigid_bodies":{)" +
         parts.document + "}}" + parts.more + "}";
}

Scene loaded(const Parts &parts)
{
  TemporaryFile file(gltf(parts));
  return read_scene_gltf(file.path);
}

std::string complaint(const Parts &parts)
{
  try {
    loaded(parts);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/* One node, called Cup, with the given motion members and shape. */
std::string cup(const std::string &motion, int shape = 0, const std::string &node = "")
{
  return R"({"name":"Cup",)" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{)" + motion +
         R"(},"collider":{"geometry":{"shape":)" + std::to_string(shape) + "}}}}}";
}

std::string collider(int shape, const std::string &node = "", const std::string &more = "")
{
  return "{" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"collider":{"geometry":{"shape":)" +
         std::to_string(shape) + "}" + more + "}}}}";
}

bool near(const Vec3 &v, double x, double y, double z)
{
  return (Eigen::Vector3d(v[0], v[1], v[2]) - Eigen::Vector3d(x, y, z)).norm() <
         1e-5 * (1 + Eigen::Vector3d(x, y, z).norm());
}

Eigen::Matrix3d rotation(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix(); }

bool collide(const Body &a, const Body &b)
{
  return (a.filter_group & b.filter_mask) && (b.filter_group & a.filter_mask);
}

} // namespace

TEST_CASE("nodes become bodies in the world")
{
  Scene scene = load_scene(scenes + "tilted_box_on_plane.gltf");
  REQUIRE(scene.bodies.size() == 3);
  CHECK(scene.gravity == Vec3{0, -9.81f, 0});
  const Body &floor = scene.bodies[0], &crate = scene.bodies[1], &ball = scene.bodies[2];
  CHECK(floor.name == "Floor");
  CHECK(floor.motion == Motion::fixed);
  CHECK(scene.shapes[floor.shape].type == ShapeType::half_space);
  CHECK(crate.motion == Motion::dynamic);
  CHECK(crate.mass == 6);
  CHECK(crate.gravity_factor == 0.5f);
  /* a quarter turn about Y takes x to -z and z to x; the group's scale doubles offset and sizes, not velocities */
  CHECK(near(crate.position, 0, 5, -2));
  CHECK(near(crate.linear_velocity, 3, 2, -1));
  CHECK(near(crate.angular_velocity, 4, 0, 0));
  CHECK(near(scene.shapes[crate.shape].size, 1, 1.5, 1));
  Eigen::Matrix3d expected = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  CHECK((rotation(crate.orientation) - expected).norm() < 1e-6);
  const Material &rubber = scene.materials[crate.material];
  CHECK(rubber.restitution == 0.9f);
  CHECK(rubber.friction_combine == Combine::multiply);
  CHECK(rubber.restitution_combine == Combine::minimum);
  CHECK(scene.materials[floor.material].friction_combine == Combine::geometric_mean);
  CHECK(scene.materials[floor.material].static_friction == 0.8f);
  CHECK(ball.name == "node 4");
  CHECK(ball.material == 0);
  CHECK(ball.mass == Approx(1000 * 4.0 / 3.0 * M_PI / 64)); /* no mass given: the density of water */
}

TEST_CASE("rotations survive the way through matrices")
{
  Eigen::Quaterniond turns[] = {{1, 0, 0, 0},          {0, 1, 0, 0},          {0, 0, 1, 0},           {0, 0, 0, 1},
                                {0.1, 0.9, 0.3, -0.2}, {-0.2, 0.1, 0.2, 0.9}, {0.01, 0.2, -0.95, 0.1}};
  for (Eigen::Quaterniond turn : turns) {
    turn.normalize();
    char node[200];
    std::snprintf(node, sizeof node, R"("rotation":[%.17g,%.17g,%.17g,%.17g],"scale":[2,3,-4],)", turn.x(), turn.y(),
                  turn.z(), turn.w());
    Scene scene = loaded({.nodes = cup("", 0, node)});
    CHECK(near(scene.shapes[0].size, 1, 1.5, 2));
    /* a mirrored box: each axis may point the other way, and the frame stays right-handed */
    Eigen::Matrix3d relative = turn.toRotationMatrix().transpose() * rotation(scene.bodies[0].orientation);
    CHECK((relative.cwiseAbs() - Eigen::Matrix3d::Identity()).norm() < 1e-5);
    CHECK(relative.determinant() == Approx(1));
  }
  Scene plane = loaded({.nodes = collider(2, R"("scale":[1,-1,1],)")});
  CHECK(
      near({float(rotation(plane.bodies[0].orientation)(0, 1)), float(rotation(plane.bodies[0].orientation)(1, 1)), 0},
           0, -1, 0));
}

TEST_CASE("a node matrix is as good as translation, rotation and scale")
{
  /* columns: 2 z, 3 x, 4 y: a turn that takes x to z, y to x, z to y */
  Scene scene =
      loaded({.nodes = cup(R"("linearVelocity":[1,0,0])", 0, R"("matrix":[0,0,2,0, 3,0,0,0, 0,4,0,0, 7,8,9,1],)")});
  CHECK(near(scene.bodies[0].position, 7, 8, 9));
  CHECK(near(scene.bodies[0].linear_velocity, 0, 0, 1));
  CHECK(near(scene.shapes[0].size, 1, 1.5, 2));
}

TEST_CASE("zero stands for an infinite mass or inertia")
{
  CHECK(loaded({.nodes = cup(R"("mass":0)")}).bodies[0].motion == Motion::kinematic);
  CHECK(loaded({.nodes = cup(R"("isKinematic":true,"angularVelocity":[0,1,0])")}).bodies[0].motion ==
        Motion::kinematic);
  Body stiff = loaded({.nodes = cup(R"("mass":1,"inertiaDiagonal":[0,0,0])")}).bodies[0];
  CHECK(stiff.motion == Motion::dynamic);
  CHECK(stiff.infinite_inertia);
  Body given =
      loaded({.nodes =
                  cup(R"("mass":1,"inertiaDiagonal":[1,2,2.5],"inertiaOrientation":[0,0,0,1],"centerOfMass":[0,0,0])")})
          .bodies[0];
  CHECK(given.inertia == Vec3{1, 2, 2.5f});
  CHECK_FALSE(given.infinite_inertia);
}

TEST_CASE("filters do what the extension says, for several systems too")
{
  const std::set<std::string> systems[] = {{"a"}, {"b"}, {"a", "b"}, {}};
  const char *system_text[] = {R"(["a"])", R"(["b"])", R"(["a","b"])", R"([])"};
  struct Rule {
    const char *text;
    std::set<std::string> only, except;
    bool has_only, has_except;
  };
  const Rule rules[] = {{"", {}, {}, false, false},
                        {R"(,"collideWithSystems":["a"])", {"a"}, {}, true, false},
                        {R"(,"notCollideWithSystems":["a"])", {}, {"a"}, false, true},
                        {R"(,"collideWithSystems":["a","b"])", {"a", "b"}, {}, true, false},
                        {R"(,"notCollideWithSystems":["b","c"])", {}, {"b", "c"}, false, true}};
  std::string filters, nodes;
  int count = 0;
  for (const char *system : system_text)
    for (const Rule &rule : rules) {
      filters += std::string(count ? "," : "") + R"({"collisionSystems":)" + system + rule.text + "}";
      nodes += (count ? "," : "") + collider(0, "", R"(,"collisionFilter":)" + std::to_string(count));
      ++count;
    }
  Scene scene = loaded({.nodes = nodes, .document = R"("collisionFilters":[)" + filters + "]"});
  REQUIRE(scene.bodies.size() == 20);
  /* "A will collide with B if A.collisionSystem ⊆ B.collideWithSystems && A.collisionSystem ⊄ B.notCollideWithSystems" */
  auto passes = [&](const std::set<std::string> &a, const Rule &b) {
    auto subset = [&](const std::set<std::string> &of) {
      return !a.empty() && std::includes(of.begin(), of.end(), a.begin(), a.end());
    };
    return (!b.has_only || subset(b.only)) && (!b.has_except || !subset(b.except));
  };
  for (size_t i = 0; i < 20; ++i)
    for (size_t j = 0; j < 20; ++j) {
      INFO("filters " << i << " and " << j);
      CHECK(collide(scene.bodies[i], scene.bodies[j]) ==
            (passes(systems[i / 5], rules[j % 5]) && passes(systems[j / 5], rules[i % 5])));
    }
}

TEST_CASE("what is not supported is refused with the node's name")
{
  const std::string prefix = temporary_path + ": node 'Cup': ";
  auto shape = [](const std::string &text) { return Parts{.nodes = cup(""), .shapes = text}; };
  CHECK(complaint(shape(R"({"type":"capsule","capsule":{}})")) ==
        prefix + "collider.geometry: shape type capsule is not supported yet; sphere, box and plane are");
  CHECK_THAT(complaint(shape(R"({"type":"cylinder"})")), ContainsSubstring(prefix) && ContainsSubstring("shape type cylinder"));
  CHECK_THAT(complaint(shape(R"({"type":"plane","plane":{"sizeX":3}})")),
             ContainsSubstring(prefix) && ContainsSubstring("a finite plane"));
  CHECK_THAT(complaint(shape(R"({"type":"plane","plane":{"doubleSided":true}})")),
             ContainsSubstring(prefix) && ContainsSubstring("a double-sided plane"));
  CHECK_THAT(complaint({.nodes = cup("", 2)}), ContainsSubstring(prefix + "a plane that moves freely"));
  CHECK_THAT(complaint({.nodes = cup(R"("centerOfMass":[0,1,0])")}),
             ContainsSubstring(prefix + "motion.centerOfMass: a centre of mass"));
  CHECK_THAT(complaint({.nodes = cup(R"("inertiaOrientation":[0,0.6,0,0.8])")}),
             ContainsSubstring(prefix) && ContainsSubstring("a rotated inertia tensor"));
  CHECK_THAT(complaint({.nodes = cup(R"("inertiaDiagonal":[1,0,1])")}),
             ContainsSubstring(prefix) && ContainsSubstring("about some axes only"));
  CHECK_THAT(complaint({.nodes = cup(R"("mass":0,"inertiaDiagonal":[1,1,1])")}),
             ContainsSubstring(prefix) && ContainsSubstring("infinite mass with a finite inertia"));
  CHECK_THAT(complaint({.nodes = cup("", 1, R"("scale":[1,2,1],)")}),
             ContainsSubstring(prefix) && ContainsSubstring("a sphere scaled unevenly"));
  CHECK_THAT(complaint({.nodes = cup("", 1, R"("scale":[1,0,1],)")}),
             ContainsSubstring(prefix) && ContainsSubstring("scale is 0 along axis 1"));
  CHECK_THAT(complaint({.nodes = cup(R"("linearVelocity":[1,0,0])", 0, R"("scale":[-1,1,1],)")}),
             ContainsSubstring(prefix) && ContainsSubstring("mirrored"));
  CHECK_THAT(complaint({.nodes = R"({"scale":[1,3,1],"children":[1]},)" + cup("", 0, R"("rotation":[0,0,0.6,0.8],)")}),
             ContainsSubstring(prefix) && ContainsSubstring("sheared"));
  auto physics = [](const std::string &text) {
    return Parts{.nodes = R"({"name":"Cup","extensions":{"KHR_physics_rigid_bodies":{)" + text + "}}}"};
  };
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"node":0,"convexHull":true}})")),
             ContainsSubstring(prefix) && ContainsSubstring("mesh geometry"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"mesh":0}})")),
             ContainsSubstring(prefix) && ContainsSubstring("mesh geometry"));
  CHECK_THAT(complaint(physics(R"("joint":{"connectedNode":1,"joint":0})")),
             ContainsSubstring(prefix + "a joint is not supported yet"));
  CHECK_THAT(complaint(physics(R"("trigger":{"geometry":{"shape":0}})")),
             ContainsSubstring(prefix + "a trigger is not supported yet"));
  CHECK_THAT(complaint(physics(R"("motion":{})")), ContainsSubstring(prefix + "a motion without a collider"));
  CHECK_THAT(complaint(physics(R"("spring":{})")), ContainsSubstring(prefix + "spring: unknown key"));
  CHECK_THAT(complaint(physics(R"("collider":{"shape":0})")), ContainsSubstring(prefix + "collider.shape: unknown key"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"shape":9}})")),
             ContainsSubstring(prefix) && ContainsSubstring("shape 9 does not exist"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":0})")),
             ContainsSubstring(prefix) && ContainsSubstring("material 0 does not exist"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":4294967295})")),
             ContainsSubstring("does not exist"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"shape":0},"collisionFilter":3})")),
             ContainsSubstring(prefix) && ContainsSubstring("filter 3 does not exist"));
  CHECK_THAT(
      complaint(
          {.nodes =
               R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},"collider":{"geometry":{"shape":0}}}}},)" +
               collider(0)}),
      ContainsSubstring("node 1: a collider below the motion of node 'Cup'"));
}

TEST_CASE("damaged node trees and files are refused")
{
  CHECK_THAT(complaint({.nodes = collider(0, R"("children":[0],)"), .more = R"(,"scenes":[{"nodes":[0]}],"scene":0)"}),
             ContainsSubstring("node 0: has two parents"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("children":[7],)")}), ContainsSubstring("node 7 does not exist"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("rotation":[0,0,0,0],)")}),
             ContainsSubstring("node 0: rotation is not a quaternion"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("translation":[1,2],)")}),
             ContainsSubstring("node 0: translation has 2 numbers"));
  CHECK_THAT(complaint({.nodes = collider(0),
                        .more = R"(,"scenes":[],"scene":0,"extensionsRequired":["KHR_draco_mesh_compression"])"}),
             ContainsSubstring("required extension KHR_draco_mesh_compression is not supported yet"));
  CHECK_THAT(complaint({.nodes = "{}"}), ContainsSubstring("no node has a collider"));
  CHECK_THAT(complaint({.nodes = cup(R"("mass":-1)")}), ContainsSubstring("body 0 'Cup': mass is -1"));
  CHECK_THAT(complaint({.nodes = cup(R"("mass":"1")")}), ContainsSubstring("node 'Cup': motion.mass"));
  CHECK_THAT(complaint({.nodes = cup(""), .shapes = R"({"type":"box","box":{"size":[1,0,1]}})"}),
             ContainsSubstring("shape 0: a half extent is 0"));
  CHECK_THAT(complaint({.nodes = cup(""), .document = R"("physicsMaterials":[{"restitution":2}])"}),
             ContainsSubstring("material 1: restitution is 2"));
  CHECK_THAT(complaint({.nodes = cup(""), .document = R"("physicsMaterials":[{"frictionCombine":"sum"}])"}),
             ContainsSubstring("physicsMaterials[0].frictionCombine"));
  CHECK_THAT(
      complaint({.nodes = cup(""),
                 .document = R"("collisionFilters":[{"collideWithSystems":["a"],"notCollideWithSystems":["b"]}])"}),
      ContainsSubstring("exclude"));
  std::string many;
  for (int i = 0; i < 32; ++i)
    many += std::string(i ? "," : "") + R"({"collisionSystems":["s)" + std::to_string(i) + R"("]})";
  CHECK_THAT(complaint({.nodes = cup(""), .document = R"("collisionFilters":[)" + many + "]"}),
             ContainsSubstring("more than 31"));
  CHECK_THAT(
      complaint(
          {.nodes = cup(""),
           .more =
               R"(,"animations":[{"samplers":[],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}])"}),
      ContainsSubstring("node 'Cup': an animated rigid body"));
  for (const char *text : {"", "{", "[]", "{}", "glTF", "glTF\x02\0\0\0\xff\xff\xff\xff",
                           R"({"asset":{"version":"2.0"},"nodes":7})", R"({"asset":3})"}) {
    TemporaryFile file(text);
    INFO(text);
    CHECK_THROWS_AS(read_scene_gltf(file.path), InputError);
  }
  TemporaryFile malformed("{\"asset\": {\n \"version\" 2}}");
  CHECK_THROWS_WITH(read_scene_gltf(malformed.path), ContainsSubstring(temporary_path + ":2:12: malformed JSON"));
}

TEST_CASE("a collider scaled to nothing is disabled")
{
  Scene scene = loaded({.nodes = collider(0) + "," + collider(0, R"("scale":[0,0,0],)")});
  CHECK(scene.bodies.size() == 1);
}

/* The scenes that come with the extensions, when they lie beside the source: TANDEM_SHARED_DATA or ../shared/data. */
TEST_CASE("the extension's own scenes load or are refused with a reason")
{
  const char *given = std::getenv("TANDEM_SHARED_DATA");
  fs::path folder = fs::path(given ? given : TANDEM_SOURCE_DIR "/../shared/data") / "gltf_physics/tests";
  if (!fs::is_directory(folder)) {
    std::cout << "skipped: no glTF physics scenes in " << folder << "\n";
    return;
  }
  std::set<std::string> loads;
  int count = 0;
  for (const auto &entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".gltf") continue;
    ++count;
    INFO(entry.path());
    try {
      Scene scene = read_scene_gltf(entry.path().string());
      CHECK(scene.bodies.size() > 0);
      loads.insert(entry.path().stem().string().substr(12));
    } catch (const InputError &error) {
      CHECK_THAT(error.what(), ContainsSubstring(": node ") && ContainsSubstring("is not supported yet"));
    }
  }
  CHECK(count == 62);
  const std::set<std::string> expected{"ColliderTypeMatrix_00", "ColliderTypeMatrix_01", "ColliderTypeMatrix_06",
                                       "ColliderTypeMatrix_07", "CollisionFilter_00",    "CollisionFilter_01",
                                       "Materials_00",          "Materials_01",          "Materials_02",
                                       "MotionProperties_00",   "MotionProperties_01",   "MotionProperties_02",
                                       "MotionProperties_03",   "MotionProperties_04",   "MotionProperties_05",
                                       "MotionProperties_06",   "MotionProperties_07"};
  CHECK(loads == expected);
}
