/* The scenes that come with the glTF physics extensions behave as their tables state: one row for each scene, closed
 * forms where there are any.
 *
 * The scenes are not part of the source (tests/host/io/gltf/gltf_scenes.h); without them the tests are skipped. */
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "host/geometry/convex_hull.h"
#include "host/io/gltf/scene.h"
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_scenes.h"
#include "tests/parity/parity.h"
#include "tests/physics/bodies.h"
#include "tests/physics/joints.h"

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

/* --- Joint: the first body is fixed, the second one is a cube of a metre and of uniform density, joined to it --- */

constexpr double moment_of_cube = 1.0 / 6; /* kg m^2 of each kg, about any axis through its middle */

/* The angle from the vertical of a pendulum that starts at rest, by Runge-Kutta. rate: that of small swings, rad/s. */
double angle_of_pendulum(double start, double rate, double seconds)
{
  using State = Eigen::Vector2d;
  const auto change = [&](const State &x) { return State(x[1], -rate * rate * std::sin(x[0])); };
  const int steps = int(std::ceil(2000 * seconds));
  const double h = seconds / std::max(steps, 1);
  State x(start, 0);
  for (int k = 0; k < steps; ++k) {
    const State a = change(x), b = change(x + 0.5 * h * a), c = change(x + 0.5 * h * b), d = change(x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return x[0];
}

/* The body swings from rest about an axis through the pivot. */
void swings(Course &course, const Vector &pivot, const Vector &axis)
{
  const Vector start = vector_of(course.start[1].position) - pivot, along = start.dot(axis) * axis, arm = start - along;
  const double angle = std::acos(-arm.y() / arm.norm()),
               rate = std::sqrt(earth * arm.norm() / (moment_of_cube + arm.squaredNorm()));
  const double sense = axis.dot(arm.cross(Vector(0, -1, 0))) > 0 ? 1 : -1; /* of falling */
  for (double seconds : {0.2, 0.4, 0.6, 0.8, 1.2, 1.6, 2.0}) {
    course.until(seconds);
    const double turned = angle - angle_of_pendulum(angle, rate, seconds);
    const Matrix turn = Eigen::AngleAxisd(sense * turned, axis).toRotationMatrix();
    const Matrix actual = axes_of(course.orientation(1)) * axes_of(course.start[1].orientation).transpose();
    CAPTURE(seconds, turned, course.moved(1).transpose());
    CHECK((course.moved(1) - (turn * start - start)).norm() < 0.01);
    CHECK((actual - turn).norm() < 0.02);
    CHECK(course.stands_still(0));
  }
}

const Vector edge(0.5, -0.5, 0.5); /* the corner at which the joints are */

void hangs_without_moving(Course &course)
{
  course.until(2);
  CHECK(course.moved(1).norm() < 2e-4);
  CHECK(angle_between(course.orientation(1), course.start[1].orientation) < 1e-4);
}

/* All moments of a cube are equal, so it swings in the plane in which it begins. */
void swings_from_its_corner(Course &course) { swings(course, edge, Vector(1, 0, -1).normalized()); }
void swings_about_x(Course &course) { swings(course, edge, Vector(1, 0, 0)); }
void swings_about_z(Course &course) { swings(course, edge, Vector(0, 0, 1)); }

/* Its hinge goes through the middle of the cube, and the centre of mass is a quarter of a metre beside it. */
void swings_about_its_middle(Course &course) { swings(course, Vector(1, 0, 0), Vector(1, 0, 0)); }

/* A slope of 45 degrees without friction, from 2 m above the fixed cube. */
void slides_from(Course &course, double end)
{
  const Vector down = Vector(1, -1, 0).normalized();
  const auto on_the_slope = [&] {
    CHECK((course.moved(1) - course.moved(1).dot(down) * down).norm() < 2e-4);
    CHECK(angle_between(course.orientation(1), course.start[1].orientation) < 1e-3);
  };
  course.until(0.5);
  CHECK(course.moved(1).dot(down) == Approx(0.5 * earth * std::sqrt(0.5) * 0.25).epsilon(0.01));
  on_the_slope();
  course.until(3);
  CAPTURE(course.place(1).transpose());
  CHECK(std::abs(course.place(1).dot(down) - end) < 0.003);
  CHECK(course.velocity(1).norm() < 1e-3);
  on_the_slope();
}

/* The joint keeps the cubes from colliding, so the second one passes the first, to the limit 2 m below. */
void slides_through_to_its_limit(Course &course) { slides_from(course, 2); }
void slides_onto_the_fixed_cube(Course &course) { slides_from(course, -1); }

/* The corner of the cube is held within a metre of a point half a metre below the fixed cube's middle. It falls freely
 * until the limit takes hold, then swings and whips round. The limit gives way to the load as every joint does: to what
 * the turn of the cube about its corner asks for, that of the corner about the point, and the weight. */
void hangs_on_a_rope_of_a_metre(Course &course)
{
  const double taut = std::sqrt(2 * std::sqrt(0.5) / earth); /* when it has fallen by the root of a half */
  double longest = 0, load = 0, highest = -10;
  for (course.until(0.1); course.world.statistics().steps < 300; course.world.step()) {
    const double seconds = double(course.world.statistics().steps) / 60;
    if (seconds < taut) CHECK((course.moved(1) - Vector(0, -0.5 * earth * seconds * seconds, 0)).norm() < 0.01);
    const Vector arm = axes_of(course.orientation(1)) * Vector(0.5, 0.5, 0.5), spin = course.spin(1);
    const Vector speed = course.velocity(1) + spin.cross(arm);
    longest = std::max(longest, (course.place(1) + arm - Vector(0, -0.5, 0)).norm());
    load = std::max(load, spin.squaredNorm() * arm.norm() + speed.squaredNorm() + earth);
    const double energy = 0.5 * course.velocity(1).squaredNorm() + 0.5 * moment_of_cube * spin.squaredNorm() +
                          earth * course.place(1).y();
    highest = std::max(highest, energy);
  }
  CAPTURE(longest, load);
  CHECK(longest > 0.9999);
  CHECK(longest < 1 + Softness(course.world.settings()).open * load);
  CHECK(highest < -earth * (1 - 0.001)); /* it began at rest, a metre below */
}

/* The drive asks for a quarter turn a second, and comes to it at the rate of its damping, whatever the mass. */
void is_driven_to_a_quarter_turn_a_second(Course &course)
{
  for (double seconds : {0.5, 1.0, 2.0, 6.0}) {
    course.until(seconds);
    const double expected = 0.5 * std::numbers::pi * (1 - std::exp(-seconds));
    CAPTURE(seconds, expected, course.spin(1).transpose());
    CHECK((course.spin(1) - Vector(expected, 0, 0)).norm() < 0.01 * expected);
    CHECK(course.moved(1).norm() < 2e-4);
  }
}

/* A spring of 100 /s^2 that is at rest where the cube begins lets it sink by g / 100, about which it swings. The
 * integrator damps too, by half a substep of the rate. */
void sinks_by_its_weight_on_a_spring(Course &course)
{
  const double sag = earth / 100, damping = 0.05 + 0.5 * 10 / 240.0;
  double lowest = 2, highest = 0, when = 0;
  for (course.world.step(); course.world.statistics().steps < 60; course.world.step()) {
    const double y = course.place(1).y();
    if (y < lowest) when = double(course.world.statistics().steps) / 60;
    lowest = std::min(lowest, y);
    highest = std::max(highest, y);
  }
  CAPTURE(lowest, highest, when);
  CHECK(lowest == Approx(2 - sag * (1 + std::exp(-damping * std::numbers::pi))).margin(0.05 * sag));
  CHECK(std::abs(when - std::numbers::pi / 10) < 1.0 / 60 + 1e-9);
  CHECK(highest < 2.0002);
  course.until(20);
  CHECK(std::abs(course.place(1).y() - (2 - sag)) < 2e-4);
  CHECK(std::hypot(course.moved(1).x(), course.moved(1).z()) < 1e-4);
  CHECK(angle_between(course.orientation(1), course.start[1].orientation) < 1e-4);
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
    {"Joint_00", "fixed joint", hangs_without_moving},
    {"Joint_01", "ball and socket joint", swings_from_its_corner},
    {"Joint_02", "hinge joint with free rotation axis 0", swings_about_x},
    {"Joint_03", "hinge joint with free rotation axis 1, which is the world's Z", swings_about_z},
    {"Joint_04", "hinge joint with free rotation axis 2", swings_about_z},
    {"Joint_05", "prismatic joint", slides_through_to_its_limit},
    {"Joint_06", "prismatic joint, collision enabled", slides_onto_the_fixed_cube},
    {"Joint_07", "a limit of the distance", hangs_on_a_rope_of_a_metre},
    {"Joint_08", "revolute joint with offset centre of mass", swings_about_its_middle},
    {"Joint_09", "revolute joint with angular drive", is_driven_to_a_quarter_turn_a_second},
    {"Joint_10", "prismatic joint with linear drive", sinks_by_its_weight_on_a_spring},
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

TEST_CASE("glTF's own scenes of filters, materials, motions and joints do what their tables say", "[physics]")
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

/* The 26 and the 36: on one thread, on all with lanes, and those with joints and some of the others with PoCL, whose
 * programs take long to build. */
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
  for (size_t i = 0; i < scenes.size(); ++i)
    if (i % stride == 2 % stride || !scenes[i].joints.empty())
      parity::require_parity(scenes[i], {"serial", "cl:pocl"}, 40, settings);
}
