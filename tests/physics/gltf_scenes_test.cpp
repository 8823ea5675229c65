/* The scenes that come with the glTF physics extensions behave as their tables state: one row for each scene, closed
 * forms where there are any.
 *
 * The scenes are not part of the source (tests/host/io/gltf/gltf_scenes.h); without them the tests are skipped. */
#include <map>

#include <fmt/format.h>

#include "host/geometry/convex_hull.h"
#include "host/io/gltf/scene.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_scenes.h"
#include "tests/parity/parity.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr double earth = 9.81; /* m/s^2, that of glTF scenes */

/* A scene that runs; bodies stand in the order of their nodes. */
struct Course {
  explicit Course(const Scene &given) : scene(given), world(given), start(world.bodies()) {}

  void until(double seconds)
  {
    while (double(world.statistics().steps) < std::round(60 * seconds)) world.step();
  }
  BodyState state(size_t body) { return world.bodies()[body]; }
  Vector place(size_t body)
  {
    return middle_of(scene.bodies[body], state(body));
  } /* of the shape's frame, which is the node */
  Vector velocity(size_t body) { return vector_of(state(body).linear_velocity); }
  Vector spin(size_t body) { return vector_of(state(body).angular_velocity); }
  Vector moved(size_t body) { return vector_of(state(body).position) - vector_of(start[body].position); }
  Quat orientation(size_t body) { return state(body).orientation; }
  bool stands_still(size_t body)
  {
    return moved(body) == Vector(0, 0, 0) && orientation(body) == start[body].orientation;
  }

  Scene scene;
  World world;
  std::vector<BodyState> start;
};

double angle_between(const Quat &a, const Quat &b)
{
  const Matrix turn = axes_of(a).transpose() * axes_of(b);
  return std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0));
}

/* --- CollisionFilter: one body rests on the floor (its top at y = 0), the other sinks in or falls through --- */

void rests(Course &course, size_t body, double height)
{
  CAPTURE(body, course.place(body).transpose(), course.velocity(body).transpose());
  CHECK(std::abs(course.place(body).y() - height) < 0.002);
  CHECK(std::hypot(course.moved(body).x(), course.moved(body).z()) < 0.002);
  CHECK(course.velocity(body).norm() < 1e-3);
}

void left_rests_right_falls_through(Course &course)
{
  course.until(2);
  rests(course, 0, 1);
  CHECK(course.moved(1).y() == Approx(-0.5 * earth * 4).epsilon(1e-4));
}

/* Two cubes one above the other, of which the filters let the upper one through the floor; the right pair stands on its
 * head. */
void left_rests_right_sinks_to_its_upper_cube(Course &course)
{
  course.until(3);
  rests(course, 0, 1.5);
  rests(course, 1, -0.5);
  for (size_t body : {0, 1}) CHECK(angle_between(course.orientation(body), course.start[body].orientation) < 0.002);
}

/* --- Materials --- */

/* A ball whose lowest point starts at height 4 bounces to e^2 of it. */
double height_of_bounce(Course &course, size_t body)
{
  double highest = 0;
  bool down = false;
  for (course.until(0.1); course.world.statistics().steps < 200; course.world.step()) {
    down = down || course.velocity(body).y() >= 0;
    if (down) highest = std::max(highest, course.place(body).y() - 1);
  }
  return highest;
}

void bounce(const Scene &scene, size_t body, double restitution)
{
  Course course(scene);
  const double height = height_of_bounce(course, body);
  CAPTURE(body, restitution, height);
  CHECK(std::abs(height - restitution * restitution * 4) < 0.01);
}

/* The larger of 0 and of the floor's 0.5; the larger of 1 and 0.5. */
void left_bounces_to_a_quarter_right_to_all(Course &course)
{
  bounce(course.scene, 0, 0.5);
  bounce(course.scene, 1, 1);
}

/* The smaller of 0.5 and of the floor's 0; the larger. */
void left_stays_right_bounces_to_a_quarter(Course &course)
{
  bounce(course.scene, 0, 0);
  bounce(course.scene, 1, 0.5);
}

/* On a slope of 45 degrees: the average of 0 and the default 0.6 lets slide at g (sin - 0.3 cos), that of 10 and 0.6
 * holds. */
void left_slides_right_sticks(Course &course)
{
  course.until(1);
  const double root = std::sqrt(0.5), expected = 0.5 * earth * root * (1 - 0.3);
  const Vector moved = course.moved(0), down(0, -root, root);
  CAPTURE(moved.transpose(), course.moved(1).transpose());
  CHECK(std::abs(moved.dot(down)) == Approx(expected).epsilon(0.01));
  CHECK((moved - moved.dot(down) * down).norm() < 0.005);
  CHECK(course.moved(1).norm() < 0.005);
}

/* --- MotionProperties --- */

void floats(Course &course)
{
  course.until(2);
  CHECK(course.stands_still(0));
}

void drifts_along_x(Course &course)
{
  course.until(2);
  CHECK((course.moved(0) - Vector(2, 0, 0)).norm() < 1e-5);
  CHECK(angle_between(course.orientation(0), course.start[0].orientation) < 1e-5);
}

void turns_about_x(Course &course)
{
  course.until(2);
  CHECK(course.moved(0).norm() < 1e-5);
  const Matrix turn = axes_of(course.orientation(0)) * axes_of(course.start[0].orientation).transpose();
  const Matrix expected = Eigen::AngleAxisd(2, Vector(1, 0, 0)).toRotationMatrix();
  CHECK((turn - expected).norm() < 1e-4);
}

/* Half within a fixed cube and without support: kinematic, so neither gravity nor the overlap moves it. */
void hangs_in_the_air(Course &course)
{
  course.until(2);
  CHECK(course.scene.bodies[1].type == BodyType::kinematic);
  for (size_t body : {0, 1}) CHECK(course.stands_still(body));
}

/* Without restitution both go on with the common velocity: of equal masses half, of 100 kg against 1 kg nearly all. */
void equal_masses_share_a_heavy_one_goes_on(Course &course)
{
  course.until(2);
  for (const auto &[first, second, mass] : {std::tuple{0, 2, 1.0}, {1, 3, 100.0}}) {
    const double common = 5 * mass / (mass + 1);
    CAPTURE(mass, common, course.velocity(first).transpose(), course.velocity(second).transpose());
    const Vector momentum = mass * course.velocity(first) + course.velocity(second);
    CHECK((momentum - Vector(5 * mass, 0, 0)).norm() < 1e-4 * mass);
    for (int body : {first, second}) CHECK((course.velocity(body) - Vector(common, 0, 0)).norm() < 0.02);
    CHECK(course.spin(first).norm() < 1e-3);
  }
}

/* Its corner alone stands on the fixed cube; with finite inertia it would tip over. */
void stands_on_a_corner_without_turning(Course &course)
{
  course.until(3);
  rests(course, 1, 1);
  CHECK(course.orientation(1) == course.start[1].orientation);
  Scene finite = course.scene;
  finite.bodies[1].infinite_inertia = false;
  Course tipping(finite);
  tipping.until(3);
  CHECK(tipping.place(1).y() < 0);
}

/* --- ColliderTypeMatrix: the second body comes to rest on the first, which is fixed --- */

/* sphere, box, capsule, cylinder, hull, mesh: the top of the fixed one, and how high the origin of the other stands on
 * it. The table asks for bodies "above the XZ plane"; the fixed box lies half a metre below it, and what it carries
 * stands there. */
constexpr double tops[] = {1, -0.5, 1, 1, 0, 0}, heights[] = {1, 0.5, 0.75, 0.5, 0, 0};

void stays_on_top(Course &course, size_t below, size_t above)
{
  const bool rocks = above >= 4 && (below == 0 || below == 2); /* a flat face on a ball: nothing damps that */
  const double expected = tops[below] + heights[above];
  for (double seconds : {2.0, 4.0}) {
    course.until(seconds);
    const Vector at = course.place(1);
    CAPTURE(seconds, expected, at.transpose(), course.velocity(1).transpose());
    CHECK(std::abs(at.y() - expected) < (rocks ? 0.015 : 0.003));
    CHECK(std::hypot(at.x(), at.z()) < 0.03);
    CHECK(course.velocity(1).norm() < (rocks ? 0.3 : 1e-3));
    CHECK(course.stands_still(0));
  }
}

/* The surface of the hull: what the table calls a triangle mesh. The file's meshes are closed and convex, and load as
 * hulls. */
void make_mesh(Shape &shape)
{
  if (!shape.hull) return;
  std::vector<uint32_t> corners;
  for (const auto &face : shape.hull->faces)
    for (size_t k = 2; k < face.size(); ++k) corners.insert(corners.end(), {face[0], face[k - 1], face[k]});
  shape = mesh_shape(shape.hull->vertices, corners, "mesh");
}

struct Row {
  const char *scene;
  const char *says;
  void (*holds)(Course &);
};
const Row rows[] = {
    {"CollisionFilter_00", "collideWithSystems: the left ball rests, the right one falls through",
     left_rests_right_falls_through},
    {"CollisionFilter_01", "notCollideWithSystems: the same", left_rests_right_falls_through},
    {"CollisionFilter_02", "collideWithSystems of two colliders each: the left pair rests, the right one sinks in",
     left_rests_right_sinks_to_its_upper_cube},
    {"CollisionFilter_03", "notCollideWithSystems of two colliders each: the same",
     left_rests_right_sinks_to_its_upper_cube},
    {"Materials_00", "high and low restitution", left_bounces_to_a_quarter_right_to_all},
    {"Materials_01", "combine modes minimum and maximum", left_stays_right_bounces_to_a_quarter},
    {"Materials_02", "high and low friction", left_slides_right_sticks},
    {"MotionProperties_00", "gravityFactor 0", floats},
    {"MotionProperties_01", "linearVelocity along X", drifts_along_x},
    {"MotionProperties_02", "angularVelocity about X", turns_about_x},
    {"MotionProperties_03", "linearVelocity along the node's Z, which is the world's X", drifts_along_x},
    {"MotionProperties_04", "angularVelocity about the node's Z, which is the world's X", turns_about_x},
    {"MotionProperties_05", "isKinematic", hangs_in_the_air},
    {"MotionProperties_06", "mass", equal_masses_share_a_heavy_one_goes_on},
    {"MotionProperties_07", "infinite inertia", stands_on_a_corner_without_turning},
};

Scene scene_of(const std::string &name) { return read_scene_gltf(gltf_scene_path(gltf_scenes(), name)); }
Scene pair_of_shapes(size_t below, size_t above)
{
  Scene scene = scene_of(fmt::format("ColliderTypeMatrix_{:02}", 6 * below + above));
  if (below == 5) make_mesh(scene.shapes[scene.bodies[0].shape]);
  if (above == 5) make_mesh(scene.shapes[scene.bodies[1].shape]);
  return scene;
}

} // namespace

TEST_CASE("glTF's own scenes of filters, materials and motions do what their tables say", "[physics]")
{
  gltf_scenes();
  for (const Row &row : rows) {
    CAPTURE(row.scene, row.says);
    Course course(scene_of(row.scene));
    row.holds(course);
  }
}

TEST_CASE("glTF's own pairs of shapes: the upper body stays on the lower one", "[physics]")
{
  gltf_scenes();
  for (size_t below = 0; below < 6; ++below)
    for (size_t above = 0; above < 6; ++above) {
      CAPTURE(below, above);
      Course course(pair_of_shapes(below, above));
      stays_on_top(course, below, above);
    }
}

/* The 15 and the 36: on one thread, on all with lanes, and some with PoCL, whose programs take long to build. */
namespace {

std::vector<Scene> all_scenes()
{
  std::vector<Scene> scenes;
  for (const Row &row : rows) scenes.push_back(scene_of(row.scene));
  for (size_t pair = 0; pair < 36; ++pair) scenes.push_back(pair_of_shapes(pair / 6, pair % 6));
  return scenes;
}

} // namespace

TEST_CASE("glTF's own scenes have the same bits on one thread and on several with lanes")
{
  gltf_scenes();
  for (const Scene &scene : all_scenes()) parity::require_parity(scene, {"serial", "tbb:threads=2,lanes=8"}, 90);
}

/* All of them with TANDEM_ALL_GLTF_SCENES set. One build of all features serves them all. */
TEST_CASE("parity on OpenCL: glTF's own scenes")
{
  gltf_scenes();
  parity::require_pocl();
  Settings settings;
  settings.specialise = false;
  const std::vector<Scene> scenes = all_scenes();
  const size_t stride = std::getenv("TANDEM_ALL_GLTF_SCENES") ? 1 : 7;
  for (size_t i = 2; i < scenes.size() + 2; i += stride)
    parity::require_parity(scenes[i % scenes.size()], {"serial", "cl:pocl"}, 40, settings);
}
