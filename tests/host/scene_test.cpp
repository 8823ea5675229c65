/* scene_test.cpp - what cannot be simulated is named; moments of inertia agree with summed volume elements. */
#include "host/scene.h"
#include "tests/catch.h"

#include <functional>
#include <limits>

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
  scene.bodies[2].motion = Motion::fixed;
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
      [](Scene &s) { s.bodies[0].motion = Motion(5); },
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
        s.bodies[0].inertia = {1, 0, 1};
      },
      [](Scene &s) {
        s.bodies[0].inertia = {1, -1, 1};
      },
      [](Scene &s) { s.bodies[0].gravity_factor = nan_value; },
      [](Scene &s) { s.bodies[0].linear_damping = -1; },
      [](Scene &s) { s.bodies[0].angular_damping = infinity; },
      [](Scene &s) { s.bodies[2].motion = Motion::dynamic; },
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

TEST_CASE("inertia agrees with summed volume elements")
{
  for (const Shape &shape : {box_shape(1, 2, 3), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.7f)}) {
    Vec3 expected = summed_inertia(shape, 2.5), actual = inertia_of(shape, 2.5f);
    for (size_t axis = 0; axis < 3; ++axis) CHECK(actual[axis] == Approx(expected[axis]).epsilon(0.002));
  }
}
