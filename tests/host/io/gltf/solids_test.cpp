/* Shapes of glTF bodies: compounds of several colliders, meshes with dents and holes, finite planes, round shapes with
 * uneven scale, mirrored nodes. Masses and poses are checked against closed forms. */
#include "host/geometry/convex_hull.h"
#include "host/geometry/shape_mass.h"
#include "host/geometry/triangle_mesh.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using namespace tandem::gltf_text;
using Catch::Matchers::ContainsSubstring;

namespace {

using Vector3 = Eigen::Vector3d;

Vector3 vector3(const Vec3 &v) { return {v[0], v[1], v[2]}; }
Vector3 vector3(const Point &p) { return {p[0], p[1], p[2]}; }

/* The pose of a child's frame in the world. */
Vector3 place_in_world(const Body &body, const Child &child)
{
  const Double3 in_body = place_of_child(body, child).position;
  return vector3(body.position) + rotation(body.orientation) * Vector3(in_body[0], in_body[1], in_body[2]);
}
Eigen::Matrix3d axes_in_world(const Body &body, const Child &child)
{
  const Rotation q = place_of_child(body, child).orientation;
  return rotation(body.orientation) * Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
}

/* Cup has the motion and, as its own collider, a box of 1 m; node 1, below, a ball of 0.5 m. */
std::string two(const std::string &motion, const std::string &node, const std::string &ball)
{
  return R"({"name":"Cup","children":[1],)" + node + R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{)" +
         motion + R"(},"collider":{"geometry":{"shape":0},"physicsMaterial":0}}}},)" +
         collider(1, ball, R"(,"physicsMaterial":1,"collisionFilter":0)");
}
const std::string materials_and_filter =
    R"("physicsMaterials":[{"restitution":0.25},{"restitution":0.5}],"collisionFilters":[{"collisionSystems":["a"],)"
    R"("collideWithSystems":["b"]}])";

const std::vector<Vec3> dented = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {0.5f, 0.4f, 0.3f}};
const std::vector<uint16_t> dented_triangles{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 4, 2, 3, 4, 3, 1, 4};

} // namespace

TEST_CASE("several colliders of one motion are a compound, each with its material and filter")
{
  const Scene scene = loaded(
      {.nodes = two("", R"("translation":[1,2,3],)", R"("translation":[0,2,0],)"), .document = materials_and_filter});
  REQUIRE(scene.bodies.size() == 1);
  const Body &body = scene.bodies[0];
  const Shape &shape = scene.shapes[body.shape];
  REQUIRE(shape.type == ShapeType::compound);
  REQUIRE(shape.compound->children.size() == 2);
  const Child &box = shape.compound->children[0], &ball = shape.compound->children[1];
  CHECK((box.shape.type == ShapeType::box && ball.shape.type == ShapeType::sphere));
  CHECK((box.material == 1u && ball.material == 2u));
  CHECK((box.filter_group == 1u && box.filter_mask == 0xffffffffu)); /* in no system, and meets all */
  CHECK((ball.filter_group == 2u && ball.filter_mask == 0u));        /* "a", of which none is "b" */
  const double volume = M_PI / 6, mass = 1000 * (1 + volume), center = 2 * volume / (1 + volume);
  CHECK(body.mass == Approx(mass));
  CHECK(near(rounded(body.position), 1, 2 + center, 3));
  CHECK((place_in_world(body, box) - Vector3(1, 2, 3)).norm() < 1e-6);
  CHECK((place_in_world(body, ball) - Vector3(1, 4, 3)).norm() < 1e-6);
  /* about Y both parts' own, about X and Z also their distances: Steiner */
  const double own_box = 1000.0 / 6, own_ball = 1000 * volume * 0.1, apart = 1000 * volume / (1 + volume) * 4;
  const Vec3 moments = inertia_of(shape, body.mass);
  const Eigen::Matrix3d axes = rotation(body.orientation),
                        tensor = axes * vector3(moments).asDiagonal() * axes.transpose();
  CHECK(tensor(1, 1) == Approx(own_box + own_ball));
  CHECK(tensor(0, 0) == Approx(own_box + own_ball + apart));
  CHECK(tensor(2, 2) == Approx(own_box + own_ball + apart));
}

TEST_CASE("mass, centre and moments that the file gives hold for compounds too")
{
  const Body body =
      loaded(
          {.nodes = two(
               R"("mass":6,"centerOfMass":[0,0.25,0],"inertiaDiagonal":[1,2,2.5],"inertiaOrientation":[0,0,0.6,0.8])",
               "", R"("translation":[0,2,0],)"),
           .document = materials_and_filter})
          .bodies[0];
  CHECK(body.mass == 6);
  CHECK(near(rounded(body.position), 0, 0.25, 0));
  CHECK(body.inertia == Vec3{1, 2, 2.5f});
  CHECK((rotation(body.orientation) - Eigen::Quaterniond(0.8, 0, 0, 0.6).toRotationMatrix()).norm() < 1e-6);
}

TEST_CASE("colliders below several turned, scaled and mirrored nodes stand where the tree puts them")
{
  /* Cup mirrors along Z and doubles; the ball hangs below a turned node that is no collider. */
  const std::string cup_node =
      R"({"name":"Cup","children":[1],"translation":[1,2,3],"scale":[2,2,-2],"rotation":[0,0.6,0,0.8],)"
      R"("extensions":{"KHR_physics_rigid_bodies":)"
      R"({"motion":{},"collider":{"geometry":{"shape":0}}}}},{"children":[2],"rotation":[0,0,0.6,0.8],)"
      R"("translation":[1,0,0]},)";
  const Scene scene = loaded({.nodes = cup_node + collider(3, R"("translation":[0,2,1],)"),
                              .shapes = R"({"type":"box","box":{}},{},{},{"type":"cylinder","cylinder":{}})"});
  const Body &body = scene.bodies[0];
  const Child &part = scene.shapes[body.shape].compound->children[1];
  CHECK(near(part.shape.size, 0.5, 0.5, 0.5));
  const Eigen::Matrix3d linear = Eigen::Quaterniond(0.8, 0, 0.6, 0).toRotationMatrix() * Vector3(2, 2, -2).asDiagonal();
  const Eigen::Matrix3d below = Eigen::Quaterniond(0.8, 0, 0, 0.6).toRotationMatrix();
  CHECK((place_in_world(body, part) - (Vector3(1, 2, 3) + linear * (Vector3(1, 0, 0) + below * Vector3(0, 2, 1))))
            .norm() < 1e-5);
  CHECK((axes_in_world(body, part).col(1) - (linear * below).col(1).normalized()).norm() < 1e-5);
  CHECK(body.mass == Approx(8000 + 1000 * M_PI * 0.25));
}

TEST_CASE("bodies whose compounds are alike share one shape")
{
  const std::string half =
      R"({"children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},)"
      R"("collider":{"geometry":{"shape":0}}}}},)" +
      collider(1, R"("translation":[0,2,0],)");
  std::string other = half;
  other.replace(other.find("[1]"), 3, "[3]");
  CHECK(loaded({.nodes = half + "," + other}).shapes.size() == 1);
  other.replace(other.find("[0,2,0]"), 7, "[0,3,0]");
  CHECK(loaded({.nodes = half + "," + other}).shapes.size() == 2);
}

TEST_CASE("a motion without a collider goes on and meets nothing")
{
  const Scene scene = loaded(
      {.nodes =
           R"({"name":"Cup","translation":[0,5,0],"extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":2,)"
           R"("linearVelocity":[1,0,0]}}}},)" +
           collider(0)});
  REQUIRE(scene.bodies.size() == 2);
  const Body &ghost = scene.bodies[0];
  CHECK((ghost.type == BodyType::dynamic && ghost.mass == 2 && ghost.linear_velocity == Vec3{1, 0, 0}));
  CHECK((ghost.filter_group & scene.bodies[1].filter_mask) == 0u);
  CHECK(near(rounded(ghost.position), 0, 5, 0));
}

TEST_CASE("meshes with dents or holes stay meshes, of bodies that move and that do not")
{
  const std::vector<uint16_t> open(tip_triangles.begin(), tip_triangles.end() - 3);
  auto scene_of = [](const std::string &mesh, const std::string &motion) {
    return loaded({.nodes = cup_of(R"("node":0)", R"("mesh":0,"scale":[1,1,-2],)", motion), .more = mesh});
  };
  for (const char *motion : {"", R"("motion":{},)"}) {
    const Scene solid = scene_of(with_mesh(dented, dented_triangles), motion);
    const Shape &shape = solid.shapes[0];
    REQUIRE(shape.type == ShapeType::mesh);
    CHECK(shape.mesh->triangles.size() == 6);
    CHECK(mass_properties_of(shape).mass == Approx(2 * 2.0 / 3)); /* the dent takes a third, the scale doubles */
    CHECK(warnings_of(solid, "f").empty());
  }
  const Scene with_hole = scene_of(with_mesh(tip_points, open), R"("motion":{},)");
  CHECK(with_hole.shapes[0].type == ShapeType::mesh);
  REQUIRE(warnings_of(with_hole, "f").size() == 1);
  CHECK_THAT(warnings_of(with_hole, "f")[0], ContainsSubstring("f: body 0 'Cup': open mesh: 3 boundary edges"));
  CHECK(warnings_of(scene_of(with_mesh(tip_points, open), ""), "f").empty()); /* what stands still needs no volume */
  CHECK(warnings_of(scene_of(with_mesh(tip_points, open), R"("motion":{"isKinematic":true},)"), "f").empty());
  const Scene hull =
      loaded({.nodes = cup_of(R"("mesh":0,"convexHull":true)"), .more = with_mesh(dented, dented_triangles)});
  CHECK(hull.shapes[0].type == ShapeType::hull);
  CHECK(hull.shapes[0].hull->vertices.size() == 4);
}

TEST_CASE("strips and fans are triangles too")
{
  /* a square in y = 0 seen from above */
  const std::vector<Vec3> corners{{-1, 0, -1}, {-1, 0, 1}, {1, 0, -1}, {1, 0, 1}};
  for (const auto &[mode, indices] : {std::pair{R"(,"mode":5)", std::vector<uint16_t>{0, 1, 2, 3}},
                                      {R"(,"mode":6)", std::vector<uint16_t>{0, 1, 3, 2}}}) {
    const Scene scene = loaded({.nodes = cup_of(R"("mesh":0)", "", ""), .more = with_mesh(corners, indices, mode)});
    const TriangleMesh &mesh = *scene.shapes[0].mesh;
    REQUIRE(mesh.triangles.size() == 2);
    for (const Triangle &t : mesh.triangles) {
      const Vector3 a = vector3(mesh.vertices[t[0]]),
                    across = (vector3(mesh.vertices[t[1]]) - a).cross(vector3(mesh.vertices[t[2]]) - a);
      CHECK((across - Vector3(0, 4, 0)).norm() < 1e-6);
    }
  }
}

TEST_CASE("planes with an end are meshes, of one side or two")
{
  auto plane = [](const std::string &members, const std::string &motion = "") {
    return loaded({.nodes = cup_of(R"("shape":0)", R"("scale":[2,5,3],)", motion),
                   .shapes = R"({"type":"plane","plane":{"sizeX":4,"sizeZ":6)" + members + "}}"});
  };
  const Scene one = plane(""), both = plane(R"(,"doubleSided":true)");
  CHECK(one.shapes[0].mesh->triangles.size() == 2);
  CHECK(both.shapes[0].mesh->triangles.size() == 4);
  const AxisAlignedBox bounds = bounds_of(one.shapes[0].mesh->vertices);
  CHECK((bounds.lower == Vec3{-4, 0, -9} && bounds.upper == Vec3{4, 0, 9}));
  CHECK(plane("", R"("motion":{"isKinematic":true,"linearVelocity":[0,1,0]},)").bodies[0].type == BodyType::kinematic);
}

TEST_CASE("round shapes scaled unevenly, and capsules with a point, are hulls of nearly their volume")
{
  auto volume = [](const std::string &shape, const std::string &scale) {
    const Scene scene = loaded({.nodes = cup_of(R"("shape":0)", R"("scale":)" + scale + ","), .shapes = shape});
    CHECK(scene.shapes[0].type == ShapeType::hull);
    return double(scene.bodies[0].mass) / 1000;
  };
  const double ball = 4.0 / 3 * M_PI;
  CHECK(volume(R"({"type":"sphere","sphere":{"radius":1}})", "[1,2,3]") == Approx(6 * ball).epsilon(0.03));
  CHECK(volume(R"({"type":"cylinder","cylinder":{"height":2,"radiusBottom":1,"radiusTop":1}})", "[1,2,3]") ==
        Approx(12 * M_PI).epsilon(0.02));
  CHECK(volume(R"({"type":"capsule","capsule":{"height":2,"radiusBottom":1,"radiusTop":1}})", "[1,1,2]") ==
        Approx(2 * (2 * M_PI + ball)).epsilon(0.03));
  /* a ball of 1 m and a point 2 m above its middle: the cone of its tangents, of half angle 30 degrees, stands on the
   * circle half a metre up */
  const double cone = M_PI * 0.75 * 1.5 / 3, cap = M_PI * 0.25 * (3 - 0.5) / 3;
  CHECK(volume(R"({"type":"capsule","capsule":{"height":2,"radiusBottom":1,"radiusTop":0}})", "[1,1,1]") ==
        Approx(ball - cap + cone).epsilon(0.03));
}

TEST_CASE("velocities and axes of inertia in mirrored nodes are mirrored as what they are")
{
  /* a mirror at x = 0 turns velocities along x round, and spins about y and z */
  const std::string motion =
      R"("mass":1,"linearVelocity":[1,2,3],"angularVelocity":[4,5,6],"inertiaDiagonal":[1,2,2.5],)"
      R"("inertiaOrientation":[0,0,0.6,0.8])";
  const Body body = loaded({.nodes = cup(motion, 0, R"("scale":[-1,1,1],)")}).bodies[0];
  CHECK(near(body.linear_velocity, -1, 2, 3));
  CHECK(near(body.angular_velocity, 4, -5, -6));
  const Eigen::Matrix3d mirror = Vector3(-1, 1, 1).asDiagonal(),
                        own = Eigen::Quaterniond(0.8, 0, 0, 0.6).toRotationMatrix();
  const Eigen::Matrix3d expected = mirror * own * Vector3(1, 2, 2.5).asDiagonal() * own.transpose() * mirror;
  const Eigen::Matrix3d axes = rotation(body.orientation),
                        tensor = axes * vector3(body.inertia).asDiagonal() * axes.transpose();
  CHECK((tensor - expected).norm() < 1e-6);
}

TEST_CASE("an inertia may be infinite about some axes alone")
{
  const Body body = loaded({.nodes = cup(R"("mass":1,"inertiaDiagonal":[0,2,0])")}).bodies[0];
  CHECK(body.inertia == Vec3{0, 2, 0});
  CHECK_FALSE(body.infinite_inertia);
}
