/* scene_test.cpp - glTF physics: node transforms against Eigen, filters against the wording of the extension, and for
 * every feature that the pipeline lacks a refusal with the node's name. */
#include <algorithm>
#include <set>

#include "host/catalog/catalog.h"
#include "host/geometry/convex_hull.h"
#include "host/io/gltf/scene.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_scenes.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;
using namespace tandem::gltf_text;

namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIR) + "/tests/scenes/";

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
  CHECK(floor.type == BodyType::fixed);
  CHECK(scene.shapes[floor.shape].type == ShapeType::half_space);
  CHECK(crate.type == BodyType::dynamic);
  CHECK(crate.mass == 6);
  CHECK(crate.gravity_factor == 0.5f);
  /* a quarter turn about Y takes x to -z and z to x; the group's scale doubles offset and sizes, not velocities */
  CHECK(near(rounded(crate.position), 0, 5, -2));
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
  CHECK(near(rounded(scene.bodies[0].position), 7, 8, 9));
  CHECK(near(scene.bodies[0].linear_velocity, 0, 0, 1));
  CHECK(near(scene.shapes[0].size, 1, 1.5, 2));
}

TEST_CASE("zero stands for an infinite mass or inertia")
{
  CHECK(loaded({.nodes = cup(R"("mass":0)")}).bodies[0].type == BodyType::kinematic);
  CHECK(loaded({.nodes = cup(R"("isKinematic":true,"angularVelocity":[0,1,0])")}).bodies[0].type ==
        BodyType::kinematic);
  Body stiff = loaded({.nodes = cup(R"("mass":1,"inertiaDiagonal":[0,0,0])")}).bodies[0];
  CHECK(stiff.type == BodyType::dynamic);
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
  /* "A will collide with B if A.collisionSystem ⊆ B.collideWithSystems &&
   * A.collisionSystem ⊄ B.notCollideWithSystems" */
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
  CHECK(complaint(shape(R"({"type":"torus","torus":{}})")) ==
        prefix +
            "collider.geometry: shape type torus is not supported yet; sphere, box, capsule, cylinder and plane are");
  CHECK_THAT(complaint(shape(R"({"type":"capsule","capsule":{"radiusTop":-1}})")),
             ContainsSubstring(prefix) &&
                 ContainsSubstring(
                     "a capsule of radii 0.25 and -1 and of height 0.5; a height above 0 and radii of at least 0"));
  CHECK_THAT(complaint(shape(R"({"type":"cylinder","cylinder":{"radius":1}})")),
             ContainsSubstring(prefix) && ContainsSubstring("radius: unknown key"));
  CHECK_THAT(complaint(shape(R"({"type":"plane","plane":{"sizeX":3}})")),
             ContainsSubstring(prefix) && ContainsSubstring("a plane finite along one axis alone"));
  CHECK_THAT(complaint(shape(R"({"type":"plane","plane":{"sizeX":3,"sizeZ":0}})")),
             ContainsSubstring(prefix) && ContainsSubstring("sizeZ: is 0; a number above 0"));
  CHECK_THAT(complaint(shape(R"({"type":"plane","plane":{"doubleSided":true}})")),
             ContainsSubstring(prefix) && ContainsSubstring("an infinite double-sided plane"));
  CHECK_THAT(complaint({.nodes = cup("", 2)}),
             ContainsSubstring(prefix) && ContainsSubstring("a plane that moves freely"));
  CHECK_THAT(complaint({.nodes = cup(R"("isKinematic":true,"centerOfMass":[0,1,0])", 2)}),
             ContainsSubstring(prefix + "motion.centerOfMass: a centre of mass of a plane"));
  CHECK_THAT(complaint({.nodes = cup(R"("inertiaOrientation":[0,0.6,0,0.8])")}),
             ContainsSubstring(prefix + "motion.inertiaOrientation: turns an inertiaDiagonal, which is missing"));
  CHECK_THAT(complaint({.nodes = cup(R"("inertiaDiagonal":[1,1,1],"inertiaOrientation":[0,6,0,0.8])")}),
             ContainsSubstring("length 1"));
  CHECK_THAT(complaint({.nodes = cup(R"("mass":0,"inertiaDiagonal":[1,1,1])")}),
             ContainsSubstring(prefix) && ContainsSubstring("infinite mass with a finite inertia"));
  CHECK_THAT(complaint({.nodes = cup("", 1, R"("scale":[1,0,1],)")}),
             ContainsSubstring(prefix) &&
                 ContainsSubstring("its scale is 0 along Y; another than 0 along each axis is needed"));
  CHECK_THAT(complaint({.nodes = R"({"scale":[1,3,1],"children":[1]},)" + cup("", 0, R"("rotation":[0,0,0.6,0.8],)")}),
             ContainsSubstring(prefix) && ContainsSubstring("sheared"));
  auto physics = [](const std::string &text) {
    return Parts{.nodes = R"({"name":"Cup","extensions":{"KHR_physics_rigid_bodies":{)" + text + "}}}"};
  };
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"node":0,"convexHull":true}})")),
             ContainsSubstring(prefix + "collider.geometry: a mesh without vertices"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"node":7}})")), ContainsSubstring("node 7 does not exist"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"node":4294967295}})")),
             ContainsSubstring("node 4294967295 does not exist; the file has 1"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"mesh":0}})")),
             ContainsSubstring(prefix + "collider.geometry: mesh 0 does not exist"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{"mesh":0,"shape":0}})")),
             ContainsSubstring(prefix + "collider.geometry: names 2 of shape"));
  CHECK_THAT(complaint(physics(R"("collider":{"geometry":{}})")),
             ContainsSubstring(prefix + "collider.geometry: names 0 of shape"));
  CHECK_THAT(complaint(physics(R"("trigger":{})")), ContainsSubstring(prefix + "trigger: \"geometry\" is missing"));
  CHECK_THAT(complaint(physics(R"("trigger":{"geometry":{"shape":0},"physicsMaterial":0})")),
             ContainsSubstring(prefix + "trigger.physicsMaterial: unknown key"));
  CHECK_THAT(complaint(physics(R"("spring":{})")), ContainsSubstring(prefix + "spring: unknown key"));
  CHECK_THAT(complaint(physics(R"("collider":{"shape":0})")),
             ContainsSubstring(prefix + "collider.shape: unknown key"));
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
               R"({"name":"Cup","children":[1],)"
               R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{"isKinematic":true}}}},)" +
               collider(2)}),
      ContainsSubstring("node 1: a plane below the motion of node 'Cup' is not supported yet"));
  CHECK_THAT(
      complaint(
          {.nodes =
               R"({"name":"Cup","children":[1,2],)"
               R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{"isKinematic":true}}}},)" +
               collider(0) + "," + collider(2)}),
      ContainsSubstring("node 2: an infinite plane in the compound of node 'Cup' is not supported yet"));
}

namespace {

std::string trigger(const std::string &members, const std::string &node = "")
{
  return "{" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"trigger":{)" + members + "}}}}";
}
const std::string ball_trigger = trigger(R"("geometry":{"shape":1})");

} // namespace

TEST_CASE("triggers become bodies that nothing touches for real")
{
  const Scene scene = loaded(
      {.nodes =
           trigger(R"("geometry":{"shape":0},"collisionFilter":0)",
                   R"("name":"Zone","translation":[1,2,3],"scale":[2,4,6],)") +
           "," + collider(2) + "," +
           R"({"name":"Scout","extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":3,"linearVelocity":[1,0,)"
           R"(0]},)" +
           R"("trigger":{"geometry":{"shape":1}}}}})",
       .document = R"("collisionFilters":[{"collisionSystems":["a"],"collideWithSystems":["b"]}])"});
  REQUIRE(scene.bodies.size() == 3);
  const Body &zone = scene.bodies[0], &floor = scene.bodies[1], &scout = scene.bodies[2];
  CHECK((zone.name == "Zone" && zone.trigger && zone.type == BodyType::fixed));
  CHECK(near(rounded(zone.position), 1, 2, 3));
  CHECK(near(scene.shapes[zone.shape].size, 1, 2, 3));
  CHECK(!collide(zone, floor)); /* in no system that it meets */
  CHECK(!floor.trigger);
  CHECK((scout.name == "Scout" && scout.trigger && scout.type == BodyType::dynamic && scout.mass == 3));
  CHECK(scene.shapes[scout.shape].type == ShapeType::sphere);
}

TEST_CASE("a trigger of listed nodes has its parts there, under the name of the one that lists them")
{
  const std::string list = R"("name":"Gate","translation":[0,5,0],"children":[1],)";
  const Scene scene = loaded({.nodes = trigger(R"("nodes":[1])", list) + "," +
                                       trigger(R"("geometry":{"shape":1})", R"("translation":[1,0,0],)")});
  REQUIRE(scene.bodies.size() == 1);
  CHECK((scene.bodies[0].name == "Gate" && scene.bodies[0].trigger));
  CHECK(near(rounded(scene.bodies[0].position), 1, 5, 0));
  const std::string place = temporary_path + ": node 'Gate': ";
  const Scene two = loaded({.nodes = trigger(R"("nodes":[1,2])", R"("name":"Gate","children":[1,2],)") + "," +
                                     ball_trigger + "," + ball_trigger});
  REQUIRE(two.bodies.size() == 1);
  CHECK(two.bodies[0].trigger);
  CHECK(two.shapes[two.bodies[0].shape].compound->children.size() == 2);
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[1])", R"("name":"Gate",)") + "," + ball_trigger}),
             ContainsSubstring(place) &&
                 ContainsSubstring("lists node 1, which is no node below it with a trigger geometry"));
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[1])", list) + "," + collider(0)}),
             ContainsSubstring("lists node 1, which is no node below it"));
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[9])", list) + "," + collider(0)}),
             ContainsSubstring("node 9 does not exist"));
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[])", list) + "," + ball_trigger}),
             ContainsSubstring(place + "trigger.nodes: is empty"));
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[1,1])", list) + "," + ball_trigger}),
             ContainsSubstring("trigger.nodes[1]: is listed twice"));
  CHECK_THAT(complaint({.nodes = trigger(R"("nodes":[1],"geometry":{"shape":0})", list) + "," + ball_trigger}),
             ContainsSubstring(place + "trigger: nodes and geometry exclude each other"));
  const std::string moves =
      R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},)"
      R"("collider":{"geometry":{"shape":0}}}}},)";
  CHECK_THAT(complaint({.nodes = moves + ball_trigger}),
             ContainsSubstring("node 1: a trigger that moves with the colliders of node 'Cup' is not supported yet"));
}

TEST_CASE("damaged node trees and files are refused")
{
  CHECK_THAT(complaint({.nodes = collider(0, R"("children":[0],)"), .more = R"(,"scenes":[{"nodes":[0]}],"scene":0)"}),
             ContainsSubstring("node 0: has two parents"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("children":[7],)")}), ContainsSubstring("node 7 does not exist"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("rotation":[0,0,0,0],)")}),
             ContainsSubstring("node 0: rotation is not a quaternion"));
  CHECK_THAT(complaint({.nodes = collider(0, R"("translation":[1,2],)")}),
             ContainsSubstring("node 0: translation: has 2 numbers"));
  CHECK_THAT(complaint({.nodes = collider(0), .more = R"(,"extensionsRequired":["KHR_interactivity"])"}),
             ContainsSubstring("required extension KHR_interactivity is not supported yet"));
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

namespace {

/* The vertices of the body's hull in the world, sorted. */
std::vector<std::array<double, 3>> corners_of(const Scene &scene, const Body &body)
{
  std::vector<std::array<double, 3>> corners;
  for (const Vec3 &v : scene.shapes[body.shape].hull->vertices) {
    const Eigen::Vector3d in_body =
        Eigen::Vector3d(body.shape_position[0], body.shape_position[1], body.shape_position[2]) +
        rotation(body.shape_orientation) * Eigen::Vector3d(v[0], v[1], v[2]);
    const Eigen::Vector3d at =
        Eigen::Vector3d(body.position[0], body.position[1], body.position[2]) + rotation(body.orientation) * in_body;
    corners.push_back({std::round(at[0] * 1e4) / 1e4 + 0.0, std::round(at[1] * 1e4) / 1e4 + 0.0,
                       std::round(at[2] * 1e4) / 1e4 + 0.0});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

using Corners = std::vector<std::array<double, 3>>;

} // namespace

TEST_CASE("capsules and cylinders become ours, with the sizes of the extension")
{
  auto shape = [](const std::string &text, const std::string &node = "") {
    const Scene scene = loaded({.nodes = cup_of(R"("shape":0)", node, ""), .shapes = text});
    return scene.shapes[0];
  };
  const Shape capsule = shape(R"({"type":"capsule","capsule":{"height":2,"radiusBottom":0.5,"radiusTop":0.25}})");
  CHECK(capsule.type == ShapeType::capsule);
  CHECK(capsule.size == Vec3{0.5f, 1, 0.25f});
  CHECK(shape(R"({"type":"capsule","capsule":{}})").size == Vec3{0.25f, 0.25f, 0.25f});
  const Shape cone = shape(R"({"type":"cylinder","cylinder":{"height":2,"radiusBottom":0.5,"radiusTop":0}})");
  CHECK(cone.type == ShapeType::cylinder);
  CHECK(cone.size == Vec3{0.5f, 1, 0});
  CHECK(shape(R"({"type":"cylinder","cylinder":{}})").size == Vec3{0.25f, 0.25f, 0.25f});
  CHECK(shape(R"({"type":"capsule","capsule":{}})", R"("scale":[2,-2,2],)").size == Vec3{0.5f, 0.5f, 0.5f});
  CHECK(shape(R"({"type":"cylinder","cylinder":{}})", R"("scale":[2,3,2],)").size == Vec3{0.5f, 0.75f, 0.5f});
}

TEST_CASE("a capsule that is a sphere really becomes one where it is")
{
  const Scene scene =
      loaded({.nodes = cup_of(R"("shape":0)", R"("translation":[1,2,3],"scale":[2,2,2],)"),
              .shapes = R"({"type":"capsule","capsule":{"height":0.5,"radiusBottom":0.25,"radiusTop":1}})"});
  CHECK(scene.shapes[0].type == ShapeType::sphere);
  CHECK(scene.shapes[0].size[0] == 2);
  CHECK(near(rounded(scene.bodies[0].position), 1, 2.5, 3));
  CHECK(scene.bodies[0].shape_position == Vec3{0, 0, 0});
}

TEST_CASE("mass, centre and axes come from the shape, each unless it is given")
{
  const std::string cone = R"({"type":"cylinder","cylinder":{"height":2,"radiusBottom":0.5,"radiusTop":0}})",
                    node = R"("translation":[1,2,3],)";
  auto body = [&](const std::string &motion) {
    return loaded({.nodes = cup(motion, 0, node), .shapes = cone}).bodies[0];
  };
  const Body own = body("");
  CHECK(own.mass == Approx(1000 * M_PI * 0.25 * 2 / 3));
  CHECK(near(rounded(own.position), 1, 1.5, 3)); /* a quarter up from the base */
  CHECK(near(own.shape_position, 0, 0.5, 0));
  CHECK(own.inertia == Vec3{0, 0, 0});
  const Body centred = body(R"("mass":3,"centerOfMass":[0,-0.75,0.25])");
  CHECK(centred.mass == 3);
  CHECK(near(rounded(centred.position), 1, 1.25, 3.25));
  CHECK(near(centred.shape_position, 0, 0.75, -0.25));
  const Body turned = body(R"("inertiaDiagonal":[1,2,2.5],"inertiaOrientation":[0,0,0.6,0.8])");
  CHECK(near(rounded(turned.position), 1, 1.5, 3));
  CHECK(turned.inertia == Vec3{1, 2, 2.5f});
  const Eigen::Matrix3d expected = Eigen::Quaterniond(0.8, 0, 0, 0.6).toRotationMatrix();
  CHECK((rotation(turned.orientation) - expected).norm() < 1e-6);
  CHECK((rotation(turned.orientation) * rotation(turned.shape_orientation) - Eigen::Matrix3d::Identity()).norm() <
        1e-6); /* the shape stays */
  const Eigen::Vector3d apex =
      rotation(turned.orientation) *
      Eigen::Vector3d(turned.shape_position[0], turned.shape_position[1], turned.shape_position[2]);
  CHECK((apex - Eigen::Vector3d(0, 0.5, 0)).norm() < 1e-6);
  const Body driven = body(R"("isKinematic":true,"angularVelocity":[0,0,1])");
  CHECK(driven.type == BodyType::kinematic);
  CHECK(near(rounded(driven.position), 1, 1.5, 3)); /* it turns about its centre of mass too */
  /* node space has the node's scale and turn: x to y, doubled */
  const Body scaled = loaded({.nodes = cup(R"("centerOfMass":[1,0,0])", 0,
                                           R"("scale":[2,2,2],"rotation":[0,0,0.70710678,0.70710678],)")})
                          .bodies[0];
  CHECK(near(rounded(scaled.position), 0, 2, 0));
  CHECK(near(scaled.shape_position, -2, 0, 0));
}

TEST_CASE("a collider below the motion is the body's shape, where it is")
{
  const std::string above =
      R"({"name":"Cup","translation":[1,2,3],"scale":[2,2,2],"rotation":[0,0,0.70710678,0.70710678],"children":[1],)"
      R"("extensions":)"
      R"({"KHR_physics_rigid_bodies":{"motion":{"centerOfMass":[0,0,0],"linearVelocity":[1,0,0]}}}},{"children":[2]},)";
  const std::string below = collider(
      0, R"("name":"Hand","translation":[1,0,0],"rotation":[0,0.6,0,0.8],"scale":[1,3,1],)", R"(,"physicsMaterial":0)");
  const Scene scene = loaded({.nodes = above + below, .document = R"("physicsMaterials":[{"restitution":0.5}])"});
  REQUIRE(scene.bodies.size() == 1);
  const Body &body = scene.bodies[0];
  CHECK(body.name == "Cup");
  CHECK(body.material == 1);
  CHECK(near(rounded(body.position), 1, 2, 3));
  CHECK(near(body.linear_velocity, 0, 1, 0));
  CHECK(near(scene.shapes[0].size, 1, 3, 1));
  CHECK(body.mass == Approx(8000.0 * 3));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                        own = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix();
  CHECK((rotation(body.orientation) * rotation(body.shape_orientation) - turn * own).norm() < 1e-6);
  const Eigen::Vector3d at = rotation(body.orientation) *
                             Eigen::Vector3d(body.shape_position[0], body.shape_position[1], body.shape_position[2]);
  CHECK((at - Eigen::Vector3d(0, 2, 0)).norm() < 1e-6);
  /* without a centre of its own, the body is where the shape is */
  const std::string plain = R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{}}}},)";
  const Scene free = loaded({.nodes = plain + collider(0, R"("translation":[1,0,0],)")});
  CHECK(near(rounded(free.bodies[0].position), 1, 0, 0));
  CHECK(free.bodies[0].shape_position == Vec3{0, 0, 0});
  /* a body below another is one of its own, and what is scaled to nothing is none */
  const Scene two = loaded(
      {.nodes =
           R"({"name":"Cup","children":[1,2],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},)"
           R"("collider":{"geometry":{"shape":0}}}}},)" +
           cup("", 1) + "," + collider(0, R"("scale":[0,0,0],)")});
  CHECK(two.bodies.size() == 2);
}

TEST_CASE("meshes become hulls: of a node, of a mesh, where asked for and where they are convex already")
{
  const Corners plain{{0, 0, 0}, {0, 0, 1}, {0, 2, 0}, {3, 0, 0}};
  for (const char *geometry : {R"("node":1,"convexHull":true)", R"("mesh":0,"convexHull":true)", R"("node":1)",
                               R"("mesh":0)", R"("node":0)"}) {
    INFO(geometry);
    const Scene scene = loaded({.nodes = cup_of(geometry, R"("mesh":0,)") + R"(,{"mesh":0,"translation":[7,7,7]})",
                                .more = with_mesh(tip_points, tip_triangles)});
    REQUIRE(scene.bodies.size() == 1);
    CHECK(scene.shapes[0].type == ShapeType::hull);
    CHECK(corners_of(scene, scene.bodies[0]) == plain);
    CHECK(scene.bodies[0].mass == Approx(1000));
    CHECK(near(rounded(scene.bodies[0].position), 0.75, 0.5, 0.25));
  }
  const std::string mesh = with_mesh(tip_points, tip_triangles);
  /* a mirroring scale turns triangles inside out, and the solid with them */
  const Scene mirrored = loaded({.nodes = cup_of(R"("node":0)", R"("mesh":0,"scale":[1,1,-2],)"), .more = mesh});
  CHECK(corners_of(mirrored, mirrored.bodies[0]) == Corners{{0, 0, -2}, {0, 0, 0}, {0, 2, 0}, {3, 0, 0}});
  /* nodes below count, where they are; the hull is of all */
  const Scene both = loaded({.nodes = cup_of(R"("node":1,"convexHull":true)", "", "") +
                                      R"(,{"mesh":0,"children":[2]},{"mesh":0,"translation":[0,0,5]})",
                             .more = mesh + R"(,"scenes":[{"nodes":[0]}])"});
  CHECK(both.shapes[0].hull->vertices.size() == 6);
  CHECK(both.bodies[0].type == BodyType::fixed);
  CHECK(both.bodies[0].position == Point{0, 0, 0});
  /* two bodies, one shape */
  const Scene twice =
      loaded({.nodes = cup_of(R"("mesh":0)") + "," + cup_of(R"("mesh":0)", R"("translation":[0,0,5],)"), .more = mesh});
  CHECK(twice.shapes.size() == 1);
}

TEST_CASE("damaged meshes are refused")
{
  const std::string prefix = temporary_path + ": node 'Cup': collider.geometry: ";
  auto told = [](const std::string &mesh, const std::string &geometry = R"("mesh":0)",
                 const std::string &more_nodes = "") {
    return complaint({.nodes = cup_of(geometry) + more_nodes, .more = mesh + R"(,"scenes":[{"nodes":[0]}])"});
  };
  CHECK_THAT(told(with_mesh(tip_points, tip_triangles, R"(,"mode":0)")),
             ContainsSubstring(prefix + "a mesh without triangles; \"convexHull\": true asks"));
  CHECK(told(with_mesh(tip_points, tip_triangles, R"(,"mode":0)"), R"("mesh":0,"convexHull":true)").empty());
  CHECK_THAT(told(with_mesh(tip_points, {0, 1, 9})),
             ContainsSubstring(prefix + "index 9 of the mesh is out of range; it has 4 vertices"));
  auto spoiled = [&](const std::string &part, const std::string &by) {
    std::string mesh = with_mesh(tip_points, tip_triangles);
    REQUIRE(mesh.find(part) != std::string::npos);
    return told(mesh.replace(mesh.find(part), part.size(), by));
  };
  CHECK_THAT(spoiled(R"("count":12)", R"("count":13)"),
             ContainsSubstring("accessor 1 of the mesh, 13 elements, lies outside its buffer"));
  CHECK_THAT(spoiled(R"("count":4)", R"("byteOffset":4,"count":4)"), ContainsSubstring("lies outside its buffer"));
  CHECK_THAT(spoiled(R"("byteLength":48})", R"("byteLength":4800})"), ContainsSubstring("lies outside its buffer"));
  CHECK_THAT(spoiled(R"("POSITION":0)", R"("POSITION":8)"),
             ContainsSubstring("accessor 8 of the mesh does not exist; the file has 2"));
  CHECK_THAT(spoiled(R"("indices":1)", R"("indices":0)"), ContainsSubstring("component type 5126"));
  CHECK_THAT(spoiled(R"("POSITION":0)", R"("POSITION":1)"),
             ContainsSubstring("not three floats each are not supported yet"));
  CHECK_THAT(spoiled(R"("primitives")", R"("weights":[0.5],"primitives")"),
             ContainsSubstring("morph targets is not supported yet"));
  CHECK_THAT(told(with_mesh(tip_points, tip_triangles), R"("node":1)", R"(,{"mesh":0,"skin":0})"),
             ContainsSubstring("deformed by a skin, is not supported yet"));
  CHECK_THAT(told(with_mesh(tip_points, tip_triangles), R"("node":1)", R"(,{"mesh":0,"children":[1]})"),
             ContainsSubstring("node 1: has two parents"));
}

TEST_CASE("the extension's own scenes load, all of them")
{
  int count = 0;
  for (const auto &entry : fs::recursive_directory_iterator(gltf_scenes())) {
    if (entry.path().extension() != ".gltf") continue;
    ++count;
    INFO(entry.path());
    const Scene scene = read_scene_gltf(entry.path().string());
    CHECK(scene.bodies.size() >= 1);
    CHECK(scene.joints.size() == (entry.path().stem().string().starts_with("RigidBodies_Joint") ? 1 : 0));
    CHECK(scene.notes.empty());
  }
  CHECK(count == 62);
}
