/* Overlaps of a convex shape with bodies: closed forms a hair to both sides of touching, separating axes in double for
 * boxes, and distances in double for all other shapes. */
#include <limits>

#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"

using namespace tandem;
using namespace tandem::physics_tests;
using namespace tandem::shape_points;
using Catch::Matchers::ContainsSubstring;

namespace {

using Overlaps = std::vector<uint32_t>;

/* What lies apart by this much, in units of sizes about 1 m, is told from what overlaps by it. */
constexpr double hair = 1e-5;

Scene scene_with_fixed(const Shape &shape, const Vector &at, const Quat &orientation = {0, 0, 0, 1})
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::fixed, shape, point_of(at)).orientation = orientation;
  return scene;
}

bool overlaps_only_body(World &world, const Shape &shape, const Pose &pose)
{
  const std::vector<Overlaps> found = world.overlap_shapes(shape, std::span(&pose, 1));
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].size() <= 1);
  return !found[0].empty();
}

/* --- boxes: the theorem of separating axes, in double --- */

struct OrientedBox {
  Vector center, half;
  Matrix axes;

  double reach(const Vector &axis) const { return (axes.transpose() * axis).cwiseAbs().dot(half); }
};

/* The largest gap along any of the fifteen axes; at most 0 if the boxes overlap. */
std::pair<double, Vector> widest_gap(const OrientedBox &a, const OrientedBox &b)
{
  std::vector<Vector> axes;
  for (int k = 0; k < 3; ++k) axes.insert(axes.end(), {a.axes.col(k), b.axes.col(k)});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes.push_back(a.axes.col(i).cross(b.axes.col(j)));
  std::pair<double, Vector> widest{-1e300, Vector::Zero()};
  for (const Vector &axis : axes) {
    if (axis.norm() < 1e-6) continue;
    const Vector n = axis.normalized();
    const double offset = n.dot(b.center - a.center), gap = std::abs(offset) - a.reach(n) - b.reach(n);
    if (gap > widest.first) widest = {gap, offset < 0 ? Vector(-n) : n};
  }
  return widest;
}

/* The inputs are floats, and the orientations are those that the library makes unit. */
OrientedBox any_oriented_box(Random &random, const Vector &center)
{
  const auto size = [&] { return double(float(random.uniform(0.1, 1.2))); };
  return {center, {size(), size(), size()}, axes_of(random.orientation())};
}

Quat quaternion_of(const Matrix &axes)
{
  const Eigen::Quaterniond q(axes);
  return {float(q.x()), float(q.y()), float(q.z()), float(q.w())};
}

/* --- other shapes: how far a point lies from them, in double, in their own axes --- */

double distance_to_segment(const Vector &p, const Vector &a, const Vector &b)
{
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

double distance_to_triangle(const Vector &p, const Vector &a, const Vector &b, const Vector &c)
{
  const Vector n = (b - a).cross(c - a).normalized();
  const bool above = n.cross(b - a).dot(p - a) >= 0 && n.cross(c - b).dot(p - b) >= 0 && n.cross(a - c).dot(p - c) >= 0;
  if (above) return std::abs(n.dot(p - a));
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

double distance_to_shape(const Vector &p, const Shape &shape)
{
  const Vector size = vector_of(shape.size);
  double least = std::numeric_limits<double>::infinity();
  switch (shape.type) {
  case ShapeType::sphere: return p.norm() - size.x();
  case ShapeType::box: return (p.cwiseAbs() - size).cwiseMax(0).norm();
  case ShapeType::capsule: return distance_to_segment(p, {0, -size.y(), 0}, {0, size.y(), 0}) - size.x();
  case ShapeType::cylinder:
    return std::hypot(std::max(std::hypot(p.x(), p.z()) - size.x(), 0.0), std::max(std::abs(p.y()) - size.y(), 0.0));
  case ShapeType::half_space: return p.y();
  case ShapeType::mesh:
    for (const auto &[i, j, k] : shape.mesh->triangles)
      least =
          std::min(least, distance_to_triangle(p, vector_of(shape.mesh->vertices[i]),
                                               vector_of(shape.mesh->vertices[j]), vector_of(shape.mesh->vertices[k])));
    return least;
  case ShapeType::compound:
    for (const Child &child : shape.compound->children)
      least =
          std::min(least, distance_to_shape(axes_of(child.orientation).transpose() * (p - vector_of(child.position)),
                                            child.shape));
    return least;
  case ShapeType::hull: break;
  }
  FAIL("no distance is known here");
  return 0;
}

Shape three_parts()
{
  std::vector<Child> children(3);
  children[0].shape = sphere_shape(0.4f);
  children[0].position = {0.7f, 0, 0};
  children[1].shape = box_shape(0.2f, 0.5f, 0.1f);
  children[1].position = {-0.5f, 0.1f, 0};
  children[1].orientation = turn_about({1, 2, 3}, 0.7);
  children[2].shape = capsule_shape(0.1f, 0.6f);
  children[2].position = {0, 0, 0.5f};
  return compound_shape(children);
}

/* Bodies of every kind that distance_to_shape knows, above a half-space. */
Scene bodies_with_distances(Random &random)
{
  Scene scene = empty_scene({0, 0, 0});
  add_ground(scene);
  const Shape shapes[] = {sphere_shape(0.7f),         box_shape(0.8f, 0.3f, 0.5f),       capsule_shape(0.3f, 0.8f),
                          cylinder_shape(0.6f, 0.4f), any_height_field(random, 9, 0.4f), three_parts()};
  for (int k = 0; k < 36; ++k) {
    const Point at{random.uniform(-3, 3), random.uniform(0, 5), random.uniform(-3, 3)};
    Body &body = add_body(scene, BodyType::fixed, shapes[k % 6], at);
    body.orientation = random.orientation();
    body.filter_group = 1u << random.below(2);
  }
  return scene;
}

double distance_to_body(const Scene &scene, uint32_t index, const Vector &point)
{
  const Body &body = scene.bodies[index];
  return distance_to_shape(axes_of(body.orientation).transpose() * (point - vector_of(body.position)),
                           scene.shapes[body.shape]);
}

} // namespace

TEST_CASE("a shape overlaps what it enters by a hair and not what it misses by a hair")
{
  const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);
  struct Touch {
    Shape query, body;
    Vector at, away; /* where the shapes touch, and the unit direction that parts them */
  };
  const Touch touches[] = {
      {sphere_shape(0.5f), sphere_shape(1), {1.5 / root3, 1.5 / root3, 1.5 / root3}, {1 / root3, 1 / root3, 1 / root3}},
      {sphere_shape(0.5f), box_shape(1, 1, 1), {0.3, 1.5, -0.2}, {0, 1, 0}},
      {sphere_shape(0.5f), box_shape(1, 1, 1), {1 + 0.5 / root2, 1 + 0.5 / root2, 0.4}, {1 / root2, 1 / root2, 0}},
      {sphere_shape(0.5f),
       box_shape(1, 1, 1),
       {1 + 0.5 / root3, 1 + 0.5 / root3, 1 + 0.5 / root3},
       {1 / root3, 1 / root3, 1 / root3}},
      {box_shape(0.5f, 0.25f, 0.5f), box_shape(1, 1, 1), {0.9, -1.25, 0.3}, {0, -1, 0}},
      {capsule_shape(0.5f, 1), box_shape(1, 1, 1), {0, 2.5, 0}, {0, 1, 0}},
      {capsule_shape(0.25f, 1), capsule_shape(0.5f, 2), {0.75, 0.5, 0}, {1, 0, 0}},
      {cylinder_shape(0.5f, 1), sphere_shape(1), {0, -2, 0}, {0, -1, 0}},
      {sphere_shape(0.5f), half_space_shape(), {7, 0.5, -3}, {0, 1, 0}},
      {box_shape(0.5f, 0.25f, 0.5f), half_space_shape(), {7, 0.25, -3}, {0, 1, 0}},
      {hull_of_box(0.5f, 0.25f, 0.75f), hull_of_box(1, 1, 1), {0.2, 0.3, 1.75}, {0, 0, 1}},
      {hull_of_box(0.5f, 0.25f, 0.75f), half_space_shape(), {7, 0.25, -3}, {0, 1, 0}},
  };
  for (const Touch &touch : touches)
    for (const Vector &origin : {Vector(0, 0, 0), Vector(2e5, -3e5, 1e5)}) {
      World world(scene_with_fixed(touch.body, origin), {}, {"serial", {}});
      const auto overlaps_at = [&](double apart) {
        return overlaps_only_body(world, touch.query, {point_of(origin + touch.at + apart * touch.away), {0, 0, 0, 1}});
      };
      CAPTURE(int(touch.query.type), int(touch.body.type), touch.at.transpose(), origin.transpose());
      CHECK(overlaps_at(-hair));
      CHECK_FALSE(overlaps_at(hair));
      CHECK(overlaps_at(-0.1));
      CHECK_FALSE(overlaps_at(0.1));
    }
}

TEST_CASE("boxes overlap where no axis in double separates them, also by a hair")
{
  Random random(61);
  size_t wrong = 0, together = 0, apart = 0, close = 0;
  for (int k = 0; k < 60; ++k) {
    OrientedBox body = any_oriented_box(random, Vector::Zero());
    const Shape shape = box_shape(float(body.half.x()), float(body.half.y()), float(body.half.z()));
    const Quat orientation = quaternion_of(body.axes);
    body.axes = axes_of(orientation);
    World world(scene_with_fixed(shape, body.center, orientation), {}, {"serial", {}});
    OrientedBox query = any_oriented_box(random, Vector::Zero());
    const Shape moved = box_shape(float(query.half.x()), float(query.half.y()), float(query.half.z()));
    std::vector<Pose> poses;
    std::vector<bool> expected;
    for (int j = 0; j < 120; ++j) {
      const Quat turn = random.orientation();
      query.axes = axes_of(turn);
      query.center = random.uniform(0, 2.5) * direction(random);
      const double wanted = j % 2 ? hair : -hair;
      if (j % 3) { /* to a hair on either side, along the axis that separates them best */
        const auto [gap, normal] = widest_gap(body, query);
        query.center += (wanted - gap) * normal;
      }
      const double gap = widest_gap(body, query).first;
      if (std::abs(gap) < 0.9 * hair) continue;
      close += std::abs(gap) < 1.1 * hair;
      (gap > 0 ? apart : together) += 1;
      poses.push_back({point_of(query.center), turn});
      expected.push_back(gap < 0);
    }
    const std::vector<Overlaps> found = world.overlap_shapes(moved, poses);
    REQUIRE(found.size() == poses.size());
    for (size_t j = 0; j < poses.size(); ++j) wrong += found[j] != (expected[j] ? Overlaps{0} : Overlaps{});
  }
  CAPTURE(together, apart, close);
  CHECK(wrong == 0);
  CHECK(together > 1500);
  CHECK(apart > 1500);
  CHECK(close > 2000);
}

TEST_CASE("a sphere overlaps every body that is nearer than its radius in double, and no other")
{
  Random random(62);
  const Scene scene = bodies_with_distances(random);
  const float radius = 0.6f;
  std::vector<Pose> poses;
  for (int k = 0; k < 2000; ++k) {
    Vector point(random.uniform(-4, 4), random.uniform(-1, 6), random.uniform(-4, 4));
    if (k % 2) { /* a hair to either side of touching one of the bodies, by a step down the slope of the distance */
      const uint32_t body = random.below(uint32_t(scene.bodies.size()));
      for (int step = 0; step < 40; ++step) {
        Vector slope;
        for (int axis = 0; axis < 3; ++axis)
          slope[axis] = distance_to_body(scene, body, point + 1e-6 * Vector::Unit(axis)) -
                        distance_to_body(scene, body, point - 1e-6 * Vector::Unit(axis));
        if (slope.norm() < 1e-9) break;
        point +=
            (double{radius} + (k % 4 == 1 ? hair : -hair) - distance_to_body(scene, body, point)) * slope.normalized();
      }
    }
    poses.push_back({point_of(point), random.orientation()});
  }
  for (const QueryFilter &filter : {QueryFilter{}, QueryFilter{0xffffffffu, 2}}) {
    World world(scene);
    const std::vector<Overlaps> found = world.overlap_shapes(sphere_shape(radius), poses, filter);
    size_t wrong = 0, hits = 0, close = 0;
    for (size_t k = 0; k < poses.size(); ++k)
      for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
        const double gap = distance_to_body(scene, body, vector_of(poses[k].position)) - double{radius};
        if (std::abs(gap) < 0.5 * hair) continue;
        const bool expected = gap < 0 && (scene.bodies[body].filter_group & filter.mask) != 0,
                   is_found = std::binary_search(found[k].begin(), found[k].end(), body);
        wrong += expected != is_found;
        hits += expected;
        close += std::abs(gap) < 2 * hair;
      }
    size_t listed = 0;
    for (const Overlaps &bodies : found) {
      wrong += std::adjacent_find(bodies.begin(), bodies.end(), std::greater_equal<>()) != bodies.end();
      listed += bodies.size();
    }
    CAPTURE(hits, close, listed);
    CHECK(wrong == 0);
    CHECK(hits > 1500);
    CHECK(close > 500);
  }
}

TEST_CASE("overlaps are found among sleeping bodies and where they have moved to")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int k = 0; k < 4; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {3.0 * k, k == 3 ? 40.0 : 0.5, 0});
  Settings settings;
  settings.sleeping = true;
  World world(scene, settings, {"serial", {}});
  const auto overlapped = [&](double x, double y) {
    const Pose pose{{x, y, 0}, {0, 0, 0, 1}};
    return world.overlap_shapes(box_shape(0.4f, 0.4f, 0.4f), std::span(&pose, 1)).front();
  };
  CHECK(overlapped(9, 40) == Overlaps{4});
  for (int k = 0; k < 120; ++k) world.step();
  REQUIRE(world.statistics().asleep == 3);
  CHECK(overlapped(0, 0.7) == Overlaps{1});
  CHECK(overlapped(0, 0.3) == Overlaps{0, 1});
  CHECK(overlapped(3, 1) == Overlaps{2});
  CHECK(overlapped(3, 1.5).empty());
  CHECK(overlapped(9, 40).empty());
  CHECK(overlapped(9, world.precise_bodies()[4].position[1]) == Overlaps{4});
}

TEST_CASE("a batch whose overlaps outgrow every list before is whole")
{
  Scene scene = empty_scene({0, 0, 0});
  for (int k = 0; k < 1000; ++k)
    add_body(scene, BodyType::fixed, sphere_shape(0.3f), {0.1 * (k % 10), 0.1 * (k / 10 % 10), 0.1 * (k / 100)});
  World world(scene);
  const Pose pose{{0.5, 0.5, 0.5}, {0, 0, 0, 1}};
  CHECK(world.overlap_shapes(sphere_shape(0.01f), std::span(&pose, 1)).front().size() < 1000);
  const std::vector<Pose> poses(50, pose);
  Overlaps all(1000);
  for (uint32_t k = 0; k < 1000; ++k) all[k] = k;
  const std::vector<Overlaps> found = world.overlap_shapes(box_shape(1, 1, 1), poses);
  CHECK(found == std::vector<Overlaps>(50, all));
}

TEST_CASE("overlap tests that mean nothing are refused, by their number")
{
  World world(scene_with_fixed(sphere_shape(1), {0, 0, 0}), {}, {"serial", {}});
  std::vector<Pose> poses(3);
  CHECK(world.overlap_shapes(sphere_shape(1), {}).empty());
  CHECK_THROWS_WITH(world.overlap_shapes(half_space_shape(), poses),
                    ContainsSubstring("overlap test") && ContainsSubstring("half_spaces"));
  CHECK_THROWS_WITH(world.overlap_shapes(sphere_shape(-1), poses), ContainsSubstring("overlap test"));
  poses[2].orientation = {0, 0, 0, 2};
  CHECK_THROWS_WITH(world.overlap_shapes(sphere_shape(1), poses),
                    ContainsSubstring("overlap test 2") && ContainsSubstring("orientation"));
  poses[1].position[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(world.overlap_shapes(sphere_shape(1), poses),
                    ContainsSubstring("overlap test 1") && ContainsSubstring("position"));
}
