/* scene_test.cpp - scenes that cannot be simulated are refused by name; moments of inertia agree with sums over volume
 * elements. */
#include <functional>
#include <limits>

#include <tandem/scene.h>
#include <tandem/world.h>

#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Scene small_scene()
{
  Scene scene;
  scene.shapes = {box_shape(1, 2, 3), sphere_shape(0.5f), half_space_shape()};
  scene.bodies.resize(3);
  scene.bodies[1].shape = 1;
  scene.bodies[2].shape = 2;
  scene.bodies[2].type = BodyType::fixed;
  scene.bodies[2].name = "floor";
  return scene;
}

std::string complaint(const std::function<void(Scene &)> &spoil)
{
  Scene scene = small_scene();
  spoil(scene);
  try {
    validate(scene, "test.json");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

/* Sum of m r² over small cubes of the shape's bounding box whose centres lie inside. */
Vec3 summed_inertia(const Shape &shape, double mass)
{
  const int cells = 80;
  double sum[3] = {0, 0, 0}, count = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        int index[3] = {i, j, k};
        double p[3], radius_squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
          double half = shape.size[size_t(axis)];
          p[axis] = half * (2 * (index[axis] + 0.5) / cells - 1);
          radius_squared += p[axis] * p[axis];
        }
        if (shape.type == ShapeType::sphere && radius_squared > double(shape.size[0]) * shape.size[0]) continue;
        ++count;
        for (int axis = 0; axis < 3; ++axis) sum[axis] += radius_squared - p[axis] * p[axis];
      }
  return {float(mass * sum[0] / count), float(mass * sum[1] / count), float(mass * sum[2] / count)};
}

} // namespace

TEST_CASE("a sound scene passes validation")
{
  CHECK(complaint([](Scene &) {}).empty());
}

TEST_CASE("validation names file, thing and reason")
{
  CHECK(complaint([](Scene &s) { s.bodies[1].mass = -2; }) ==
        "test.json: body 1: mass is -2; a finite number above 0 is needed");
  CHECK(complaint([](Scene &s) {
          s.bodies[2].position[1] = nan_value;
        }).find("test.json: body 2 'floor': position is [0, nan, 0]") == 0);
  CHECK_THAT(complaint([](Scene &s) { s.shapes[0].size[1] = 0; }), ContainsSubstring("shape 0: a half extent is 0"));
  CHECK_THAT(complaint([](Scene &s) { s.shapes[1].size = {-1, -1, -1}; }), ContainsSubstring("shape 1: radius is -1"));
  CHECK_THAT(complaint([](Scene &s) { s.shapes[0].size[2] = infinity; }), ContainsSubstring("shape 0: size"));
  CHECK_THAT(complaint([](Scene &s) { s.shapes[0].type = ShapeType(9); }), ContainsSubstring("unknown shape type"));
}

TEST_CASE("validation refuses what the solver could not bear")
{
  std::function<void(Scene &)> spoilers[] = {
      [](Scene &s) { s.gravity[0] = infinity; },
      [](Scene &s) { s.materials.clear(); },
      [](Scene &s) { s.materials[0].static_friction = -0.1f; },
      [](Scene &s) { s.materials[0].dynamic_friction = nan_value; },
      [](Scene &s) { s.materials[0].restitution = 1.5f; },
      [](Scene &s) { s.materials[0].rolling_friction = -0.1f; },
      [](Scene &s) { s.materials[0].spinning_friction = nan_value; },
      [](Scene &s) { s.materials[0].friction_combine = Combine(7); },
      [](Scene &s) { s.bodies[0].shape = 3; },
      [](Scene &s) { s.bodies[0].material = 1; },
      [](Scene &s) { s.bodies[0].type = BodyType(5); },
      [](Scene &s) {
        s.bodies[0].orientation = {0, 0, 0, 0};
      },
      [](Scene &s) {
        s.bodies[0].orientation = {0, 0, 0, 2};
      },
      [](Scene &s) {
        s.bodies[0].orientation = {nan_value, 0, 0, 1};
      },
      [](Scene &s) { s.bodies[0].linear_velocity[2] = infinity; },
      [](Scene &s) { s.bodies[0].angular_velocity[0] = nan_value; },
      [](Scene &s) { s.bodies[0].mass = 0; },
      [](Scene &s) { s.bodies[0].mass = infinity; },
      [](Scene &s) { s.bodies[0].mass = 1e-42f; },
      [](Scene &s) {
        s.bodies[0].inertia = {1, nan_value, 1};
      },
      [](Scene &s) {
        s.bodies[0].inertia = {1, -1, 1};
      },
      [](Scene &s) { s.bodies[0].gravity_factor = nan_value; },
      [](Scene &s) { s.bodies[0].linear_damping = -1; },
      [](Scene &s) { s.bodies[0].angular_damping = infinity; },
      [](Scene &s) { s.bodies[2].type = BodyType::dynamic; },
      [](Scene &s) { s.shapes[1] = sphere_shape(1e-22f); }, /* its inertia underflows */
  };
  for (size_t i = 0; i < std::size(spoilers); ++i) {
    INFO("spoiler " << i);
    CHECK_FALSE(complaint(spoilers[i]).empty());
  }
  CHECK(complaint([](Scene &s) { s.bodies[2].mass = -1; }).empty()); /* a fixed body's mass is ignored */
  CHECK(complaint([](Scene &s) {
          s.bodies[1].infinite_inertia = true;
          s.shapes[1] = sphere_shape(1e-22f);
        }).empty());
}

TEST_CASE("validation of capsules, cylinders, hulls and of shapes with a pose")
{
  auto shape = [](const Shape &given) { return complaint([&](Scene &s) { s.shapes[0] = given; }); };
  CHECK(shape(capsule_shape(0.5f, 1)).empty());
  CHECK(shape({ShapeType::capsule, {0.5f, 1, 2.49f}}).empty());
  CHECK_THAT(shape({ShapeType::capsule, {0.5f, 1, 2.5f}}),
             ContainsSubstring("holds the other; a sphere of radius 2.5 is the same"));
  CHECK_THAT(shape({ShapeType::capsule, {0, 1, 0.5f}}), ContainsSubstring("shape 0: radius_bottom is 0"));
  CHECK_THAT(shape({ShapeType::capsule, {0.5f, 1, -1}}), ContainsSubstring("shape 0: radius_top is -1"));
  CHECK_THAT(shape(capsule_shape(0.5f, 0)), ContainsSubstring("shape 0: half_height is 0"));
  CHECK(shape(cylinder_shape(0.5f, 1)).empty());
  CHECK(shape(cone_shape(0.5f, 1)).empty());
  CHECK(shape({ShapeType::cylinder, {0, 1, 0.5f}}).empty());
  CHECK_THAT(shape({ShapeType::cylinder, {0, 1, 0}}), ContainsSubstring("the larger radius is 0"));
  CHECK_THAT(shape({ShapeType::cylinder, {-1, 1, 1}}), ContainsSubstring("radius_bottom is -1"));
  CHECK_THAT(shape({ShapeType::cylinder, {1, nan_value, 1}}), ContainsSubstring("size"));
  CHECK_THAT(shape({ShapeType::hull, {0, 0, 0}}), ContainsSubstring("shape 0: a hull without points"));

  auto pose = [](const Vec3 &position, const Quat &orientation, size_t body) {
    return complaint(
        [&](Scene &s) { s.bodies[body].shape_position = position, s.bodies[body].shape_orientation = orientation; });
  };
  CHECK(pose({1, 2, 3}, {0, 0, 0, 1}, 0).empty());
  CHECK(pose({1, 2, 3}, {0.6f, 0, 0, 0.8f}, 1).empty()); /* all axes of a sphere are principal ones */
  CHECK_THAT(pose({0, nan_value, 0}, {0, 0, 0, 1}, 0), ContainsSubstring("shape_position is [0, nan, 0]"));
  CHECK_THAT(pose({0, 0, 0}, {0, 0, 0, 2}, 0),
             ContainsSubstring("shape_orientation is [0, 0, 0, 2]; a quaternion of length 1"));
  CHECK_THAT(pose({0, 1, 0}, {0, 0, 0, 1}, 2), ContainsSubstring("body 2 'floor': a half_space has no pose"));
  CHECK_THAT(pose({0, 0, 0}, {0.6f, 0, 0, 0.8f}, 2), ContainsSubstring("a half_space has no pose"));
}

/* Three moments say nothing of axes that are not the body's. */
TEST_CASE("validation refuses moments from a shape that is turned in its body")
{
  const Quat slanted{0.6f, 0, 0, 0.8f}, upended{0, 0, 0.70710678f, 0.70710678f};
  auto turned = [](const Shape &shape, const Quat &orientation, const Vec3 &inertia = {0, 0, 0}) {
    return complaint([&](Scene &s) {
      s.shapes[0] = shape;
      s.bodies[0].shape_orientation = orientation;
      s.bodies[0].inertia = inertia;
    });
  };
  CHECK_THAT(turned(box_shape(1, 2, 3), slanted),
             ContainsSubstring("body 0: inertia from shape and mass is about the shape's principal axes"));
  CHECK_FALSE(turned(box_shape(1, 2, 3), upended).empty()); /* principal axes, under other names */
  CHECK(turned(box_shape(1, 2, 3), slanted, {1, 1, 1}).empty());
  CHECK(turned(box_shape(1, 1, 1), slanted).empty());
  CHECK(turned(cylinder_shape(1, 2), {0, 0.6f, 0, 0.8f}).empty()); /* about its axis */
  CHECK_FALSE(turned(cylinder_shape(1, 2), slanted).empty());
  const std::vector<Vec3> wedge{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  CHECK_FALSE(turned(hull_shape(wedge, "wedge"), {0, 0, 0, 1}).empty());
  CHECK(complaint([&](Scene &s) {
          s.shapes[0] = hull_shape(wedge, "wedge");
          take_mass_properties(s, s.bodies[0]);
        }).empty());
}

TEST_CASE("inertia agrees with summed volume elements")
{
  for (const Shape &shape : {box_shape(1, 2, 3), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.7f)}) {
    Vec3 expected = summed_inertia(shape, 2.5), actual = inertia_of(shape, 2.5f);
    for (size_t axis = 0; axis < 3; ++axis) CHECK(actual[axis] == Approx(expected[axis]).epsilon(0.002));
  }
}

TEST_CASE("numbers whose powers and sums are no floats are refused, field by field")
{
  const std::vector<Shape> largest{sphere_shape(1e9f),      box_shape(1e9f, 1, 1),  box_shape(1, 1, 1e9f),
                                   capsule_shape(1e9f, 1),  capsule_shape(1, 1e9f), cylinder_shape(1e9f, 1),
                                   cylinder_shape(1, 1e9f), cone_shape(1e9f, 1)};
  const auto said = [](const Shape &shape) {
    return complaint([&](Scene &s) {
      s.shapes[0] = shape;
      s.bodies[0].type = BodyType::fixed;
    });
  };
  for (const Shape &shape : largest) {
    CHECK(said(shape).empty());
    for (const float factor : {2.0f, 1e10f, 3e29f}) {
      Shape larger = shape;
      for (float &x : larger.size) x *= x == 1e9f ? factor : 1;
      CHECK(said(larger).find("so that what is computed from it stays a float") != std::string::npos);
      Child child;
      child.shape = larger;
      CHECK_FALSE(said(compound_shape({child})).empty());
    }
  }
  const std::vector<Vec3> far{{0, 0, 0}, {0, 0, 2e9f}, {2e9f, 0, 0}, {0, 2e9f, 0}};
  CHECK(said(hull_shape(far, "far")).find("a vertex of the hull") != std::string::npos);
  Child child;
  child.shape = sphere_shape(1);
  child.position = {0, -2e9f, 0};
  CHECK(said(compound_shape({child})).find("child 0: position is -2") != std::string::npos);
  CHECK(complaint([](Scene &s) { s.bodies[0].position = {1e18, -1e18, 0}; }).empty());
  const std::vector<std::function<void(Scene &)>> spoilers{
      [](Scene &s) { s.bodies[0].position[1] = -2e18; },
      [](Scene &s) { s.bodies[0].position[2] = 1e300; },
      [](Scene &s) {
        s.bodies[0].shape_position = {2e9f, 0, 0};
      },
      [](Scene &s) { s.bodies[0].mass = 2e36f; },
      [](Scene &s) { s.bodies[0].mass = 5e-37f; },
      [](Scene &s) {
        s.bodies[0].inertia = {1, 2e36f, 1};
      },
      [](Scene &s) {
        s.bodies[0].inertia = {1, 1, 5e-37f};
      },
      [](Scene &s) { s.materials[0].static_friction = 2e9f; },
      [](Scene &s) { s.materials[0].dynamic_friction = 2e9f; },
      [](Scene &s) { s.materials[0].rolling_friction = 1e30f; },
      [](Scene &s) { s.materials[0].spinning_friction = 3e38f; },
  };
  for (size_t i = 0; i < spoilers.size(); ++i) {
    INFO("spoiler " << i);
    CHECK_FALSE(complaint(spoilers[i]).empty());
  }
}

TEST_CASE("the largest shapes meet what is in them")
{
  for (const Shape &shape :
       {sphere_shape(1e9f), box_shape(1e9f, 1e9f, 1e9f), capsule_shape(1e9f, 1e9f), cylinder_shape(1e9f, 1e9f)}) {
    Scene scene;
    scene.shapes = {shape, sphere_shape(1)};
    Body large, small;
    large.type = BodyType::fixed;
    small.shape = 1;
    scene.bodies = {large, small};
    World world(scene, {}, Placement{"serial", {}, false});
    world.step();
    CHECK(world.statistics().pairs == 1);
    CHECK(world.statistics().contacts > 0);
    CHECK(world.quarantined().empty());
  }
}
