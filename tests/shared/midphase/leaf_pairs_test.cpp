/* The list of leaf pairs against every leaf of one body with every leaf of the other, placed in double precision. */
#include <set>

#include "host/geometry/convex_hull.h"
#include "host/geometry/shape_mass.h"
#include "host/geometry/triangle_mesh.h"
#include "host/runtime/memory.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Points of a leaf, about the centre of its body; their hull lies within it. */
struct OracleLeaf {
  uint32_t child, triangle; /* INDEX_NONE where there is none; the triangle counts from the first of its mesh */
  std::vector<Vector> points;
};

Quat quat_of(const Rotation &q) { return {float(q[0]), float(q[1]), float(q[2]), float(q[3])}; }

std::vector<Vector> points_within(const Shape &shape)
{
  std::vector<Vector> points;
  const Vector size = vector_of(shape.size);
  if (shape.hull)
    for (const Vec3 &v : shape.hull->vertices) points.push_back(vector_of(v));
  else if (shape.type == ShapeType::box)
    for (int k = 0; k < 8; ++k)
      points.push_back(Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(size));
  else
    for (double end : {-1.0, 1.0}) /* sphere or capsule */
      for (int k = 0; k < 6; ++k)
        points.push_back(Vector(0, shape.type == ShapeType::capsule ? end * size.y() : 0, 0) +
                         (k & 1 ? 1 : -1) * size.x() * Vector::Unit(k / 2));
  return points;
}

void add_leaves(std::vector<OracleLeaf> &leaves, uint32_t child, const Shape &shape, const ShapePlace &place)
{
  const Vector at(place.position[0], place.position[1], place.position[2]);
  const Matrix turn = axes_of(quat_of(place.orientation));
  const auto add = [&](uint32_t triangle, const std::vector<Vector> &own) {
    leaves.push_back({child, triangle, {}});
    for (const Vector &p : own) leaves.back().points.push_back(at + turn * p);
  };
  if (!shape.mesh) return add(INDEX_NONE, points_within(shape));
  for (uint32_t t = 0; t < shape.mesh->triangles.size(); ++t) {
    const auto &[i, j, k] = shape.mesh->triangles[t];
    add(t,
        {vector_of(shape.mesh->vertices[i]), vector_of(shape.mesh->vertices[j]), vector_of(shape.mesh->vertices[k])});
  }
}

std::vector<OracleLeaf> leaves_of(const Scene &scene, const Body &body)
{
  std::vector<OracleLeaf> leaves;
  const Shape &shape = scene.shapes[body.shape];
  const Rotation turn{body.shape_orientation[0], body.shape_orientation[1], body.shape_orientation[2],
                      body.shape_orientation[3]};
  const ShapePlace own{{body.shape_position[0], body.shape_position[1], body.shape_position[2]}, turn};
  if (!shape.compound) add_leaves(leaves, INDEX_NONE, shape, own);
  else
    for (uint32_t k = 0; k < shape.compound->children.size(); ++k)
      add_leaves(leaves, k, shape.compound->children[k].shape, place_of_child(body, shape.compound->children[k]));
  return leaves;
}

/* An upper bound of the distance of two hulls of points: Frank and Wolfe's descent on their Minkowski difference,
 * 1956. */
double distance_at_most(const std::vector<Vector> &a, const std::vector<Vector> &b, double enough)
{
  Vector x = a[0] - b[0];
  for (int round = 0; round < 300 && x.norm() > enough; ++round) {
    const auto nearer = [&](const Vector &p, const Vector &q) { return p.dot(x) < q.dot(x); };
    const Vector step =
        *std::min_element(a.begin(), a.end(), nearer) - *std::max_element(b.begin(), b.end(), nearer) - x;
    if (step.dot(x) > -1e-12) break;
    x += std::min(1.0, -step.dot(x) / step.squaredNorm()) * step;
  }
  return x.norm();
}

std::vector<Vector> placed(const std::vector<Vector> &points, const BodyState &state)
{
  std::vector<Vector> result;
  for (const Vector &p : points) result.push_back(vector_of(state.position) + axes_of(state.orientation) * p);
  return result;
}

Shape knot(Random &random)
{
  std::vector<Child> children;
  for (int k = 0; k < 5; ++k) {
    Child child;
    child.shape = k % 3 == 0   ? sphere_shape(0.2f)
                  : k % 3 == 1 ? box_shape(0.2f, 0.1f, 0.3f)
                               : capsule_shape(0.1f, 0.2f);
    child.position = vec3_of(Vector(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)));
    child.orientation = random.orientation();
    children.push_back(child);
  }
  return compound_shape(std::move(children));
}

Shape hills(Random &random)
{
  std::vector<float> heights;
  for (int i = 0; i < 15 * 12; ++i) heights.push_back(float(random.uniform(-0.3, 0.3)));
  return height_field_shape(heights, 15, 0.3f, 0.35f, "hills");
}

/* Meshes, compounds of shapes and of a mesh, and single shapes, all in one heap. */
Scene heap(uint64_t seed)
{
  Random random(seed);
  Scene scene = empty_scene({0, 0, 0});
  Body &ground = add_body(scene, BodyType::fixed, hills(random), {0, 0, 0});
  ground.orientation = random.orientation();
  Child child;
  child.shape = hills(random);
  child.position = {0.3f, 0.1f, -0.2f};
  child.orientation = random.orientation();
  Child second;
  second.shape = sphere_shape(0.4f);
  Body &rock = add_body(scene, BodyType::fixed, compound_shape({child, second}), {0.5, 0.2, 0.1});
  rock.orientation = random.orientation();
  for (int k = 0; k < 12; ++k) {
    const Shape shape = k % 3 ? knot(random) : hull_of_box(0.3f, 0.2f, 0.1f);
    Body &body = add_dynamic_body(scene, shape, {random.uniform(-2, 2), random.uniform(-1, 1), random.uniform(-2, 2)},
                                  random.orientation());
    body.linear_velocity = vec3_of(Vector(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)));
  }
  return scene;
}

Settings settings_with(Midphase midphase)
{
  Settings settings;
  settings.midphase = midphase;
  return settings;
}

using LeafPair = std::array<uint32_t, 6>; /* scene bodies, then child and triangle of either */

} // namespace

TEST_CASE("no two leaves that meet are missed, none stand twice, and few that are far apart stand in the list")
{
  const uint64_t seed = GENERATE(1, 2, 3, 4);
  const Midphase midphase = GENERATE(from_range(choices<Midphase>()));
  const Scene scene = heap(seed);
  World world(scene, settings_with(midphase));
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  std::vector<BodyState> before = world.bodies();
  size_t close = 0, listed_in_all = 0;
  for (int step = 0; step < 3; ++step) {
    before = world.bodies();
    world.step();
    Memory &memory = world.memory();
    const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    const uint32_t pairs = counts[COUNT_PAIRS];
    const auto a = memory.read<uint32_t>(Buffer::pair_a, pairs), b = memory.read<uint32_t>(Buffer::pair_b, pairs);
    const auto leaf = memory.read<uint32_t>(Buffer::pair_leaf, 4 * size_t{pairs}),
               trees = memory.read<uint32_t>(Buffer::body_tree, 2 * scene.bodies.size());
    /* The second mesh of the scene starts behind the first: a triangle's number within its own mesh. */
    const uint32_t first_mesh = uint32_t(scene.shapes[0].mesh->triangles.size());
    std::set<LeafPair> listed;
    for (uint32_t i = 0; i < pairs; ++i) {
      LeafPair entry{world.scene_body(a[i]), world.scene_body(b[i])};
      for (uint32_t side = 0; side < 2; ++side) {
        const uint32_t body = side ? b[i] : a[i], shape = leaf[4 * i + 2 * side], triangle = leaf[4 * i + 2 * side + 1];
        entry[2 + 2 * side] = shape == body ? INDEX_NONE : shape - trees[2 * body + 1];
        entry[3 + 2 * side] = triangle == INDEX_NONE ? INDEX_NONE : entry[side] == 1 ? triangle - first_mesh : triangle;
      }
      CAPTURE(seed, midphase, step, i);
      REQUIRE(listed.insert(entry).second);
    }
    listed_in_all += listed.size();
    for (uint32_t i = 0; i < pairs; ++i) {
      const uint32_t first = world.scene_body(a[i]), second = world.scene_body(b[i]);
      if (i > 0 && a[i] == a[i - 1] && b[i] == b[i - 1]) continue; /* all leaves of two bodies at once */
      for (const OracleLeaf &p : leaves_of(scene, scene.bodies[first]))
        for (const OracleLeaf &q : leaves_of(scene, scene.bodies[second])) {
          const auto at_p = placed(p.points, before[first]), at_q = placed(q.points, before[second]);
          if (distance_at_most(at_p, at_q, 0.005) > 0.005) continue;
          ++close;
          CAPTURE(seed, midphase, step, first, second, p.child, p.triangle, q.child, q.triangle);
          REQUIRE(listed.count({first, second, p.child, p.triangle, q.child, q.triangle}) == 1);
        }
    }
  }
  CHECK(close > 60);
  CHECK(listed_in_all < 20 * close); /* boxes of slanted leaves, margins and motion take some more */
}

/* The list outgrows its room in the first step, which then runs again. */
TEST_CASE("a list of leaf pairs that outgrows its room loses nothing")
{
  Scene scene = empty_scene();
  std::vector<float> heights(61 * 61, 0.0f);
  add_body(scene, BodyType::fixed, height_field_shape(heights, 61, 0.1f, 0.1f, "floor"), {0, 0, 0});
  add_dynamic_body(scene, box_shape(2.5f, 0.1f, 2.5f), {0, 0.1, 0});
  const Midphase midphase = GENERATE(from_range(choices<Midphase>()));
  CAPTURE(midphase);
  World world(scene, settings_with(midphase));
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  run(world, 5);
  const Statistics statistics = world.statistics();
  CHECK(statistics.pairs > 4000);
  CHECK(statistics.overflow >= 1);
  CHECK(statistics.contacts == 4);
  CHECK(std::abs(world.bodies()[1].position[1] - 0.1) < 0.005);
}

TEST_CASE("leaf pairs: no two points of a joined manifold are one, and the deepest is among them")
{
  Scene scene = empty_scene({0, 0, 0});
  Random random(4);
  std::vector<float> heights(21 * 21, 0.0f);
  add_body(scene, BodyType::fixed, height_field_shape(heights, 21, 0.2f, 0.2f, "floor"), {0, 0, 0});
  for (int k = 0; k < 20; ++k) {
    const double tilt = random.uniform(0, 0.01);
    add_dynamic_body(scene, box_shape(0.35f, 0.2f, 0.3f), {random.uniform(-1.5, 1.5), 0.197, random.uniform(-1.5, 1.5)},
                     turn_about(Vector(random.uniform(-1, 1), 0, random.uniform(-1, 1)), tilt));
    scene.bodies.back().filter_group = 2;
    scene.bodies.back().filter_mask = 1;
  }
  World world(scene);
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  const std::vector<BodyState> states = world.bodies();
  world.step();
  Memory &memory = world.memory();
  const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
  const uint32_t pairs = counts[COUNT_PAIRS], stride = counts[CAPACITY_PAIRS];
  const auto a = memory.read<uint32_t>(Buffer::pair_a, pairs), b = memory.read<uint32_t>(Buffer::pair_b, pairs),
             n = memory.read<uint32_t>(Buffer::manifold_count, pairs);
  const auto points = memory.read<float4>(Buffer::manifold_points, 4 * size_t{stride});
  std::vector<int> manifolds(scene.bodies.size());
  for (uint32_t i = 0; i < pairs; ++i) {
    if (n[i] == 0) continue;
    const uint32_t body = std::max(world.scene_body(a[i]), world.scene_body(b[i]));
    ++manifolds[body];
    double lowest = INFINITY, deepest = INFINITY;
    for (int k = 0; k < 8; ++k) {
      const Vector corner = Vector(k & 1 ? 0.35 : -0.35, k & 2 ? 0.2 : -0.2, k & 4 ? 0.3 : -0.3);
      lowest = std::min(lowest, (vector_of(states[body].position) + axes_of(states[body].orientation) * corner).y());
    }
    for (uint32_t k = 0; k < n[i]; ++k) {
      deepest = std::min(deepest, double(points[k * stride + i].w));
      for (uint32_t j = 0; j < k; ++j)
        CHECK(std::hypot(points[k * stride + i].x - points[j * stride + i].x,
                         points[k * stride + i].z - points[j * stride + i].z) > 0.05);
    }
    CAPTURE(body, lowest, deepest);
    CHECK(n[i] == 4);
    CHECK(deepest ==
          Approx(lowest).margin(1e-4)); /* what leads by less than a ten-thousandth of the size need not win */
  }
  for (size_t body = 1; body < scene.bodies.size(); ++body) CHECK(manifolds[body] == 1);
}
