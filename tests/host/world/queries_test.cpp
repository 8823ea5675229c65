/* Rays and shape casts: closed forms for each shape from outside, inside, grazing and parallel; random rays against an
 * independent oracle in double; ties, filters, and refused arguments. */
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/geometry/convex_hull.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

Scene scene_of(const std::vector<Shape> &shapes)
{
  Scene scene;
  scene.shapes = shapes;
  for (uint32_t k = 0; k < shapes.size(); ++k) {
    Body body;
    body.shape = k;
    body.type = BodyType::fixed;
    scene.bodies.push_back(body);
  }
  return scene;
}

Ray ray_from(const Vector &origin, const Vector &direction, float reach = std::numeric_limits<float>::infinity())
{
  Ray ray;
  ray.origin = point_of(origin);
  ray.direction = vec3_of(direction);
  ray.reach = reach;
  return ray;
}

RayHit cast(World &world, const Ray &ray) { return world.cast_rays(std::span(&ray, 1)).front(); }

struct Expected {
  Shape shape;
  Vector origin, direction;
  double fraction; /* below 0: no hit */
  Vector normal;
};

Shape octahedron()
{
  const std::vector<Vec3> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  return hull_shape(points, "octahedron");
}

/* --- the oracle: how far a point lies outside of a shape, in double; a ray is walked along by it --- */

struct BodyShape {
  const Scene *scene;
  const Body *body;
  Eigen::Matrix3d axes;
  Vector middle;

  BodyShape(const Scene &s, const Body &b) : scene(&s), body(&b)
  {
    const auto q = [](const Quat &v) { return Eigen::Quaterniond(v[3], v[0], v[1], v[2]).normalized(); };
    axes = (q(b.orientation) * q(b.shape_orientation)).toRotationMatrix();
    middle = vector_of(b.position) + q(b.orientation) * vector_of(b.shape_position);
  }
  const Shape &shape() const { return scene->shapes[body->shape]; }

  /* At most the distance, exact enough that walking by it converges; negative inside. */
  double height(const Vector &point) const
  {
    const Vector p = axes.transpose() * (point - middle), e = vector_of(shape().size);
    switch (shape().type) {
    case ShapeType::sphere: return p.norm() - e.x();
    case ShapeType::box: return (p.cwiseAbs() - e).maxCoeff();
    case ShapeType::half_space: return p.y();
    case ShapeType::mesh:
    case ShapeType::compound: break; /* queries_trees_test.cpp has them */
    case ShapeType::hull: {
      double most = -1e300;
      for (const HullPlane &plane : shape().hull->planes)
        most = std::max(most,
                        plane.normal[0] * p.x() + plane.normal[1] * p.y() + plane.normal[2] * p.z() - plane.distance);
      return most;
    }
    case ShapeType::cylinder: {
      const Eigen::Vector2d out = Eigen::Vector2d(2 * e.y(), e.x() - e.z()).normalized();
      return std::max(std::abs(p.y()) - e.y(),
                      out.dot(Eigen::Vector2d(std::hypot(p.x(), p.z()) - e.x(), p.y() + e.y())));
    }
    case ShapeType::capsule: {
      const double sine = (e.x() - e.z()) / (2 * e.y()), cosine = std::sqrt(1 - sine * sine);
      const Eigen::Vector2d q(std::hypot(p.x(), p.z()), p.y() + e.y());
      const double along = q.dot(Eigen::Vector2d(-sine, cosine));
      if (along < 0) return q.norm() - e.x();
      if (along > cosine * 2 * e.y()) return (q - Eigen::Vector2d(0, 2 * e.y())).norm() - e.z();
      return q.dot(Eigen::Vector2d(cosine, sine)) - e.x();
    }
    }
    return 0;
  }
};

/* The height along a line is convex: its least value by ternary search where the line is near, then the first crossing
 * by bisection. */
double first_crossing(const BodyShape &body_shape, const Vector &origin, const Vector &unit, double length,
                      double *least)
{
  constexpr double radius = 1.8; /* of every shape here about its origin, and more */
  *least = 1e300;
  const double nearest = unit.dot(body_shape.middle - origin);
  double low = 0, high = length;
  if (body_shape.shape().type != ShapeType::half_space) {
    if ((origin + nearest * unit - body_shape.middle).norm() > radius || nearest < -radius) return -1;
    low = std::max(0.0, nearest - radius);
    high = nearest + radius;
  }
  if (body_shape.height(origin) <= 0) return *least = 0;
  const double begin = low;
  while (high - low > 1e-10 * (1 + high)) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (body_shape.height(origin + a * unit) < body_shape.height(origin + b * unit)) high = b;
    else low = a;
  }
  *least = body_shape.height(origin + low * unit);
  if (*least > 0) return -1;
  double outside = begin, inside = low;
  for (int k = 0; k < 45; ++k) {
    const double middle = 0.5 * (outside + inside);
    (body_shape.height(origin + middle * unit) > 0 ? outside : inside) = middle;
  }
  return 0.5 * (outside + inside);
}

Shape random_hull_shape(Random &random)
{
  std::vector<Vec3> cloud;
  for (int k = 0; k < 20; ++k) cloud.push_back(vec3_of(direction(random).cwiseProduct(Vector(0.6, 0.9, 0.7))));
  return hull_shape(cloud, "stone");
}

/* Every shape, posed in its body, about the origin. */
Scene scattered(uint64_t seed, double size)
{
  Random random(seed);
  Scene scene = scene_of({sphere_shape(0.7f), box_shape(0.9f, 0.5f, 0.7f), capsule_shape(0.4f, 0.6f),
                          Shape{ShapeType::capsule, {0.6f, 0.5f, 0.2f}}, Shape{ShapeType::capsule, {0.1f, 0.7f, 0.5f}},
                          cylinder_shape(0.5f, 0.8f), cylinder_shape(1.0f, 0.05f), cone_shape(0.7f, 0.6f),
                          Shape{ShapeType::cylinder, {0.2f, 0.5f, 0.8f}}, random_hull_shape(random), octahedron(),
                          sphere_shape(0.2f)});
  for (Body &body : scene.bodies) {
    body.position = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    body.orientation = random.orientation();
    body.shape_position = {float(random.uniform(-0.3, 0.3)), float(random.uniform(-0.3, 0.3)), 0};
    body.shape_orientation = random.orientation();
  }
  scene.shapes.push_back(half_space_shape());
  Body ground;
  ground.shape = uint32_t(scene.shapes.size() - 1);
  ground.type = BodyType::fixed;
  ground.position = {0, -size - 1, 0};
  scene.bodies.push_back(ground);
  return scene;
}

std::string refusal(World &world, std::vector<Ray> rays)
{
  try {
    world.cast_rays(rays);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("rays meet each shape where its closed form says")
{
  const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3);
  const Shape taper{ShapeType::capsule, {1.0f, 1.0f, 0.5f}};
  const Expected cases[] = {
      {sphere_shape(1), {-3, 0, 0}, {1, 0, 0}, 2, {-1, 0, 0}},
      {sphere_shape(1), {-3, 0, 0}, {4, 0, 0}, 0.5, {-1, 0, 0}},
      {sphere_shape(1), {-3, 0.6, 0}, {1, 0, 0}, 2.2, {-0.8, 0.6, 0}},
      {sphere_shape(1), {-3, 1.001, 0}, {1, 0, 0}, -1, {}},
      {sphere_shape(1), {3, 0, 0}, {1, 0, 0}, -1, {}},
      {sphere_shape(1), {0.2, 0, 0}, {1, 0, 0}, 0, {-1, 0, 0}},
      {box_shape(1, 2, 3), {-3, 1, 2}, {1, 0, 0}, 2, {-1, 0, 0}},
      {box_shape(1, 2, 3), {-3, 2.5, 0}, {1, 0, 0}, -1, {}},
      {box_shape(1, 2, 3), {-3, 4, 0}, {1, -1, 0}, 2, {-1, 0, 0}},
      {box_shape(1, 2, 3), {0, 0, 0}, {0, 0, 1}, 0, {0, 0, -1}},
      {box_shape(1, 2, 3), {0, 5, 0}, {0, -2, 0}, 1.5, {0, 1, 0}},
      {half_space_shape(), {0, 4, 0}, {1, -2, 0}, 2, {0, 1, 0}},
      {half_space_shape(), {0, 4, 0}, {1, 0, 0}, -1, {}},
      {half_space_shape(), {0, -1, 0}, {0, 1, 0}, 0, {0, -1, 0}},
      {capsule_shape(1, 2), {-3, 1, 0}, {1, 0, 0}, 2, {-1, 0, 0}},
      {capsule_shape(1, 2), {0, 5, 0}, {0, -1, 0}, 2, {0, 1, 0}},
      {capsule_shape(1, 2), {-3, 2.6, 0}, {1, 0, 0}, 2.2, {-0.8, 0.6, 0}},
      {capsule_shape(1, 2), {1.001, 9, 0}, {0, -1, 0}, -1, {}},
      {taper, {0, 3, 0}, {0, -1, 0}, 1.5, {0, 1, 0}},
      {taper, {0, -3, 0}, {0, 1, 0}, 1, {0, -1, 0}},
      {taper,
       {-5, 0.25, 0},
       {1, 0, 0},
       5 - (1 - 1.25 * 0.25) / std::sqrt(1 - 0.0625),
       {-std::sqrt(1 - 0.0625), 0.25, 0}},
      {cylinder_shape(1, 2), {-3, 1, 0}, {1, 0, 0}, 2, {-1, 0, 0}},
      {cylinder_shape(1, 2), {0.5, 5, 0}, {0, -1, 0}, 3, {0, 1, 0}},
      {cylinder_shape(1, 2), {1.001, 5, 0}, {0, -1, 0}, -1, {}},
      {cylinder_shape(1, 2), {-3, 2.001, 0}, {1, 0, 0}, -1, {}},
      {cylinder_shape(1, 2), {-3, 1, 0.6}, {1, 0, 0}, 2.2, {-0.8, 0, 0.6}},
      {cone_shape(1, 1), {-3, 0, 0}, {1, 0, 0}, 2.5, {-2 / std::sqrt(5.0), 1 / std::sqrt(5.0), 0}},
      {cone_shape(1, 1), {0, 3, 0}, {0, -1, 0}, 2, {0, 0, 0}}, /* the tip has no normal of its own */
      {cone_shape(1, 1), {0.5, -3, 0}, {0, 1, 0}, 2, {0, -1, 0}},
      {cone_shape(1, 1), {-3, 1.001, 0}, {1, 0, 0}, -1, {}},
      {Shape{ShapeType::cylinder, {2, 1, 1}},
       {1.5, 3, 0},
       {0, -1, 0},
       3,
       {half * std::sqrt(2) * 2 / std::sqrt(5.0), 1 / std::sqrt(5.0), 0}},
      {octahedron(), {-3, 0.2, 0.2}, {1, 0, 0}, 3 - 0.6, {-third, third, third}},
      {octahedron(), {-3, 0.6, 0.6}, {1, 0, 0}, -1, {}},
      {octahedron(), {0.1, 0, 0}, {0, 0, 3}, 0, {0, 0, -1}},
  };
  for (const Expected &expected : cases) {
    World world(scene_of({expected.shape}), {}, {"serial", {}});
    const RayHit hit = cast(world, ray_from(expected.origin, expected.direction));
    CAPTURE(int(expected.shape.type), expected.origin.transpose(), expected.direction.transpose(), expected.fraction,
            hit.fraction);
    REQUIRE((hit.body == 0) == (expected.fraction >= 0));
    if (expected.fraction < 0) continue;
    CHECK(hit.fraction == Approx(expected.fraction).margin(2e-6));
    CHECK((vector_of(hit.point) - (expected.origin + expected.fraction * expected.direction)).norm() < 2e-5);
    if (expected.normal.norm() > 0) CHECK((vector_of(hit.normal) - expected.normal).norm() < 1e-5);
    CHECK(vector_of(hit.normal).norm() == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("a hundred thousand random rays find what an oracle in double finds")
{
  const Scene scene = scattered(3, 4);
  World world(scene);
  std::vector<BodyShape> body_shapes;
  for (const Body &body : scene.bodies) body_shapes.emplace_back(scene, body);
  Random random(4);
  std::vector<Ray> rays;
  for (int k = 0; k < 100000; ++k) {
    const double away = k % 4 == 0 ? 1000 : 9;
    Ray ray = ray_from(away * direction(random), {1, 0, 0});
    ray.direction =
        vec3_of(Vector(5 * direction(random) * random.uniform(0, 1) - vector_of(ray.origin)) * random.uniform(0.1, 3));
    ray.reach = float((away + 50) / vector_of(ray.direction).norm());
    rays.push_back(ray);
  }
  const std::vector<RayHit> hits = world.cast_rays(rays);
  size_t wrong = 0, found = 0, grazing = 0, checked = 0;
  double largest = 0, tilted = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    const Vector origin = vector_of(rays[k].origin), unit = vector_of(rays[k].direction).normalized();
    const double length = vector_of(rays[k].direction).norm(), rounding = 1e-6 * (origin.norm() + 10);
    double nearest = 1e300, doubt = 1e300;
    uint32_t body = no_body;
    for (uint32_t b = 0; b < body_shapes.size(); ++b) {
      double least;
      const double at = first_crossing(body_shapes[b], origin, unit, length * double{rays[k].reach}, &least);
      doubt = std::min(doubt, std::abs(least) + (least == 0 ? 1 : 0));
      if (at >= 0 && at < nearest) nearest = at, body = b;
    }
    ++checked;
    if (doubt < 4 * rounding) { /* by rounding it hits or misses */
      ++grazing;
      continue;
    }
    const RayHit &hit = hits[k];
    if (hit.body != body) {
      wrong += hit.body == no_body || body == no_body || std::abs(double{hit.fraction} * length - nearest) > rounding;
      continue;
    }
    if (body == no_body) continue;
    ++found;
    const double slope = nearest > 0 ? std::abs(unit.dot(vector_of(hit.normal))) : 1;
    largest = std::max(largest, std::abs(double{hit.fraction} * length - nearest) * slope / (origin.norm() + 10));
    if (nearest > 0)
      tilted = std::max(tilted,
                        body_shapes[body].height(vector_of(hit.point) + 1e-3 * vector_of(hit.normal)) < 0 ? 1.0 : 0.0);
  }
  CAPTURE(found, wrong, grazing, largest, checked);
  CHECK(wrong == 0);
  CHECK(largest < 3e-6); /* height over the surface, of the distance */
  CHECK(tilted == 0);
  CHECK(found > 40000);
  CHECK(grazing < 2000);
}

TEST_CASE("of bodies hit at one place the lowest index answers, whatever their size")
{
  Scene scene = scene_of({sphere_shape(0.1f), box_shape(1, 1, 1), box_shape(50, 1, 50), sphere_shape(0.2f)});
  scene.bodies[0].position = {0, 9, 0};
  scene.bodies[3].position = {0, -20, 0};
  World world(scene, {}, {"serial", {}}); /* the large box stands first in the buffers */
  CHECK(cast(world, ray_from({0, 5, 0}, {0, -1, 0})).body == 1);
  CHECK(cast(world, ray_from({10, 5, 0}, {0, -1, 0})).body == 2);
  CHECK(cast(world, ray_from({0, 5, 0}, {0, -1, 0}, 3.9f)).body == no_body);
  CHECK(cast(world, ray_from({0, 5, 0}, {0, -1, 0}, 4.1f)).body == 1);
  CHECK(cast(world, ray_from({0, 5, 0}, {0, -4, 0}, 1)).fraction == 1);
  CHECK(world.cast_rays({}).empty());
}

TEST_CASE("queries and bodies must accept each other's groups")
{
  Scene scene = scene_of({sphere_shape(1), sphere_shape(1)});
  scene.bodies[0].position = {3, 0, 0};
  scene.bodies[0].filter_group = 2;
  scene.bodies[0].filter_mask = 8;
  scene.bodies[1].position = {9, 0, 0};
  World world(scene, {}, {"serial", {}});
  Ray ray = ray_from({0, 0, 0}, {1, 0, 0});
  CHECK(cast(world, ray).body == 0);
  ray.filter = {8, 2};
  CHECK(cast(world, ray).body == 0);
  ray.filter = {8, 1};
  CHECK(cast(world, ray).body == 1);
  ray.filter = {4, 3};
  CHECK(cast(world, ray).body == 1);
  ray.filter = {8, 4};
  CHECK(cast(world, ray).body == no_body);
  const Pose start;
  const Vec3 displacement{20, 0, 0};
  CHECK(world.cast_shapes(sphere_shape(0.5f), std::span(&start, 1), std::span(&displacement, 1), {8, 1}).front().body ==
        1);
}

TEST_CASE("queries see bodies where they are now, and leave the simulation as it was")
{
  Scene scene = scene_of({sphere_shape(0.5f), half_space_shape()});
  scene.bodies[0].type = BodyType::dynamic;
  scene.bodies[0].position = {0, 4, 0};
  World world(scene), other(scene);
  for (int k = 0; k < 30; ++k) {
    world.step();
    other.step();
    const RayHit hit = cast(world, ray_from({0, 100, 0}, {0, -1, 0}));
    CHECK(hit.body == 0);
    CHECK(hit.point[1] == Approx(world.bodies()[0].position[1] + 0.5).margin(2e-5));
  }
  CHECK(world.state_hash() == other.state_hash());
}

TEST_CASE("a ray a thousand kilometres from the origin is as exact as one at home")
{
  Scene scene = scene_of({sphere_shape(0.5f)});
  scene.bodies[0].position = {1e6 + 0.125, 7e5, -3e5};
  World world(scene, {}, {"serial", {}});
  const RayHit hit = cast(world, ray_from({1e6 - 1.875, 7e5 + 0.3, -3e5}, {1, 0, 0}));
  CHECK(hit.fraction == Approx(2 - 0.4).margin(1e-6));
}

TEST_CASE("rays that mean nothing are refused, by their number")
{
  World world(scene_of({sphere_shape(1)}), {}, {"serial", {}});
  const Ray good = ray_from({-3, 0, 0}, {1, 0, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  Ray bad = good;
  bad.direction = {0, 0, 0};
  CHECK_THAT(refusal(world, {good, good, bad}),
             ContainsSubstring("ray 2") && ContainsSubstring("direction is [0, 0, 0]"));
  bad.direction = {1, nan, 0};
  CHECK_THAT(refusal(world, {good, bad}), ContainsSubstring("ray 1") && ContainsSubstring("direction"));
  bad = good;
  bad.origin[1] = double{infinite};
  CHECK_THAT(refusal(world, {bad}), ContainsSubstring("ray 0") && ContainsSubstring("origin"));
  bad = good;
  bad.reach = -1;
  CHECK_THAT(refusal(world, {bad}), ContainsSubstring("reach is -1"));
  bad.reach = nan;
  CHECK_THAT(refusal(world, {bad}), ContainsSubstring("reach"));
  CHECK(refusal(world, {good}).empty());

  const Pose pose;
  const Vec3 displacement{1, 0, 0}, endless{infinite, 0, 0};
  CHECK_THROWS_WITH(world.cast_shapes(half_space_shape(), std::span(&pose, 1), std::span(&displacement, 1)),
                    ContainsSubstring("half_space"));
  CHECK_THROWS_WITH(world.cast_shapes(sphere_shape(-1), std::span(&pose, 1), std::span(&displacement, 1)),
                    ContainsSubstring("radius"));
  CHECK_THROWS_WITH(world.cast_shapes(sphere_shape(1), std::span(&pose, 1), {}),
                    ContainsSubstring("1 poses and 0 displacements"));
  CHECK_THROWS_WITH(world.cast_shapes(sphere_shape(1), std::span(&pose, 1), std::span(&endless, 1)),
                    ContainsSubstring("shape cast 0"));
}

TEST_CASE("shape casts stop where shapes touch: closed forms")
{
  struct ShapeCast {
    Shape moving, standing;
    Vector from, displacement;
    double fraction;
    Vector point, normal;
  };
  const ShapeCast cases[] = {
      {sphere_shape(0.5f), sphere_shape(1), {-4, 0, 0}, {5, 0, 0}, 0.5, {-1, 0, 0}, {-1, 0, 0}},
      {sphere_shape(0.5f), sphere_shape(1), {-4, 1.6, 0}, {5, 0, 0}, -1, {}, {}},
      {sphere_shape(0.5f), half_space_shape(), {0, 2.5, 0}, {1, -4, 0}, 0.5, {0.5, 0, 0}, {0, 1, 0}},
      {box_shape(0.5f, 0.5f, 0.5f), sphere_shape(1), {0, 4, 0}, {0, -5, 0}, 0.5, {0, 1, 0}, {0, 1, 0}},
      {capsule_shape(0.5f, 1), box_shape(1, 1, 1), {0, 6, 0}, {0, -7, 0}, 0.5, {0, 1, 0}, {0, 1, 0}},
      {octahedron(), half_space_shape(), {0, 3, 0}, {0, -4, 0}, 0.5, {0, 0, 0}, {0, 1, 0}},
      {octahedron(), sphere_shape(1), {0, 4, 0}, {0, -4, 0}, 0.5, {0, 1, 0}, {0, 1, 0}},
      {sphere_shape(0.5f), octahedron(), {0, -3, 0}, {0, 3, 0}, 0.5, {0, -1, 0}, {0, -1, 0}},
      {sphere_shape(0.5f), sphere_shape(1), {-1, 0, 0}, {5, 0, 0}, 0, {-1, 0, 0}, {-1, 0, 0}},
      {sphere_shape(0.5f), sphere_shape(1), {-4, 0, 0}, {2, 0, 0}, -1, {}, {}},
  };
  for (const ShapeCast &cast : cases) {
    World world(scene_of({cast.standing}), {}, {"serial", {}});
    const Pose pose{point_of(cast.from), {0, 0, 0, 1}};
    const Vec3 displacement = vec3_of(cast.displacement);
    const ShapeCastHit hit = world.cast_shapes(cast.moving, std::span(&pose, 1), std::span(&displacement, 1)).front();
    CAPTURE(int(cast.moving.type), int(cast.standing.type), cast.from.transpose(), cast.fraction, hit.fraction,
            hit.body);
    REQUIRE((hit.body == 0) == (cast.fraction >= 0));
    if (cast.fraction < 0) continue;
    CHECK(hit.fraction <= cast.fraction + 1e-6);
    CHECK(hit.fraction == Approx(cast.fraction).margin(2e-5));
    CHECK((vector_of(hit.point) - cast.point).norm() <
          2e-3); /* of a corner on a sphere: the root of the touching distance */
    CHECK((vector_of(hit.normal) - cast.normal).norm() < 1e-3);
  }
}

/* A sphere that is swept is a ray against what is a radius larger: for every shape the oracle's height, less the
 * radius, where it is a distance. Here for spheres, capsules and half-spaces, whose heights are distances
 * everywhere. */
TEST_CASE("a swept sphere stops where the distance in double is its radius")
{
  Scene scene = scattered(8, 4);
  std::vector<BodyShape> body_shapes;
  for (Body &body : scene.bodies) {
    const ShapeType type = scene.shapes[body.shape].type;
    if (type != ShapeType::sphere && type != ShapeType::capsule && type != ShapeType::half_space) body.filter_group = 2;
  }
  for (const Body &body : scene.bodies)
    if (body.filter_group == 1) body_shapes.emplace_back(scene, body);
  World world(scene);
  Random random(9);
  const double radius = 0.3;
  std::vector<Pose> poses;
  std::vector<Vec3> paths;
  for (int k = 0; k < 5000; ++k) {
    const Vector from = 9 * direction(random);
    poses.push_back({point_of(from), random.orientation()});
    paths.push_back(vec3_of(1.5 * (4 * direction(random) * random.uniform(0, 1) - from)));
  }
  const std::vector<ShapeCastHit> hits = world.cast_shapes(sphere_shape(float(radius)), poses, paths, {0xffffffffu, 1});
  size_t wrong = 0, found = 0, missed = 0, inside = 0;
  double late = -1e9, early = -1e9;
  for (size_t k = 0; k < hits.size(); ++k) {
    const auto clearance = [&](double fraction) {
      double least = 1e300;
      for (const BodyShape &body_shape : body_shapes)
        least =
            std::min(least, body_shape.height(vector_of(poses[k].position) + fraction * vector_of(paths[k])) - radius);
      return least;
    };
    if (clearance(0) < 0) {
      ++inside;
      wrong += hits[k].body == no_body || hits[k].fraction != 0;
      continue;
    }
    const double end = hits[k].body == no_body ? 1 : double{hits[k].fraction};
    for (int sample = 0; sample <= 200; ++sample)
      wrong += clearance(end * sample / 200) < -1e-5; /* never through anything */
    if (hits[k].body == no_body) {
      ++missed;
      continue;
    }
    ++found;
    late = std::max(late, -clearance(end));
    early = std::max(early, clearance(end));
  }
  CAPTURE(found, missed, wrong, late, early);
  CHECK(wrong == 0);
  CHECK(late < 1e-5);
  CHECK(early < 1e-4);
  CHECK(found > 800);
  CHECK(missed > 100);
  CHECK(inside > 100);
}
