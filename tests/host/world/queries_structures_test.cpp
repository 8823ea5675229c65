/* Queries give the same bits with every structure: the hierarchy, the uniform grid, or every body one by one. */
#include <cstring>
#include <limits>

#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"

using namespace tandem;
using namespace tandem::physics_tests;
using namespace tandem::shape_points;

namespace {

constexpr float endless = std::numeric_limits<float>::infinity();

struct Questions {
  std::vector<Ray> rays;
  std::vector<QueryBox> boxes;
  std::vector<Pose> poses;
  std::vector<Vec3> paths;
};

struct Answers {
  std::vector<RayHit> rays;
  std::vector<bool> blocked;
  std::vector<std::vector<RayHit>> through;
  std::vector<std::vector<BoxHit>> boxes;
  std::vector<ShapeCastHit> casts;
  std::vector<std::vector<uint32_t>> overlaps;
  size_t found = 0, overlapped = 0;
};

bool same(const QueryHit &p, const QueryHit &q)
{
  return p.body == q.body && std::memcmp(&p.fraction, &q.fraction, sizeof(float)) == 0 &&
         std::memcmp(&p.point, &q.point, sizeof(Point)) == 0 && std::memcmp(&p.normal, &q.normal, sizeof(Vec3)) == 0;
}
bool same(const BoxHit &p, const BoxHit &q)
{
  return p.body == q.body && std::memcmp(&p.fraction, &q.fraction, sizeof(float)) == 0;
}
bool same(bool p, bool q) { return p == q; }
template <class Hit> bool same(const std::vector<Hit> &p, const std::vector<Hit> &q)
{
  return std::equal(p.begin(), p.end(), q.begin(), q.end(), [](const auto &a, const auto &b) { return same(a, b); });
}

Answers ask(const Scene &scene, const Questions &questions, Broadphase broadphase, const char *backend)
{
  Settings settings;
  settings.broadphase = broadphase;
  World world(scene, settings, {backend, {}});
  Answers a{world.cast_rays(questions.rays),
            world.cast_rays_any(questions.rays),
            world.cast_rays_all(questions.rays),
            world.cast_boxes(questions.boxes),
            {},
            {}};
  for (const Shape &shape : {sphere_shape(0.2f), box_shape(0.3f, 0.1f, 0.6f)}) {
    const std::vector<ShapeCastHit> hits = world.cast_shapes(shape, questions.poses, questions.paths, {1, 3});
    a.casts.insert(a.casts.end(), hits.begin(), hits.end());
    const auto bodies = world.overlap_shapes(shape, questions.poses, {1, 3});
    a.overlaps.insert(a.overlaps.end(), bodies.begin(), bodies.end());
  }
  for (const auto &hits : a.through) a.found += hits.size();
  for (const auto &bodies : a.overlaps) a.overlapped += bodies.size();
  return a;
}

/* Every body one by one is the oracle of the others. */
void require_equal_answers(const Scene &scene, const Questions &questions, size_t least)
{
  const Answers expected = ask(scene, questions, Broadphase::brute_force, "serial");
  CHECK(expected.found >= least);
  CHECK(expected.overlapped > 0);
  for (const Broadphase broadphase : {Broadphase::brute_force, Broadphase::grid, Broadphase::bvh})
    for (const char *backend : {"serial", "tbb"}) {
      CAPTURE(broadphase, backend);
      const Answers found = ask(scene, questions, broadphase, backend);
      CHECK(same(found.rays, expected.rays));
      CHECK(same(found.blocked, expected.blocked));
      CHECK(same(found.through, expected.through));
      CHECK(same(found.boxes, expected.boxes));
      CHECK(same(found.casts, expected.casts));
      CHECK(found.overlaps == expected.overlaps);
    }
}

Point anywhere(Random &random, const Point &middle, double size)
{
  return {middle[0] + random.uniform(-size, size), middle[1] + random.uniform(-size, size),
          middle[2] + random.uniform(-size, size)};
}

/* Segments from near and far, from inside a body, toward a body or past all of them, along axes and diagonals, and of
 * length 0 where that is allowed. */
struct Segment {
  Point from;
  Vec3 displacement;
};

Segment any_displacement(const Scene &scene, Random &random, double size)
{
  const auto body = [&]() -> const Body & { return scene.bodies[random.below(uint32_t(scene.bodies.size()))]; };
  const Point about = body().position, to = random.below(3) ? body().position : anywhere(random, about, size);
  const uint32_t kind = random.below(8);
  Segment w{kind < 4    ? anywhere(random, about, size)
            : kind == 4 ? anywhere(random, about, 1000 * size)
                        : body().position,
            {}};
  for (size_t axis = 0; axis < 3; ++axis)
    w.displacement[axis] = float(random.uniform(0.2, 2) * (to[axis] - w.from[axis]));
  if (random.below(4) == 0) {
    const size_t axis = random.below(3);
    w.displacement = {0, 0, 0};
    w.displacement[axis] = random.below(2) ? 1.5f : -float(size);
    w.from = to;
    w.from[axis] -= random.uniform(-1, 1) * double(w.displacement[axis]);
  }
  if (random.below(8) == 0)
    for (float &x : w.displacement) x = random.below(2) ? 2.0f : -2.0f;
  return w;
}

Questions questions_about(const Scene &scene, Random &random, size_t count, double size)
{
  Questions q;
  while (q.rays.size() < count) {
    const Segment ray = any_displacement(scene, random, size), box = any_displacement(scene, random, size),
                  cast = any_displacement(scene, random, size);
    if (std::hypot(double{ray.displacement[0]}, double{ray.displacement[1]}, double{ray.displacement[2]}) < 1e-10)
      continue;
    const float reaches[] = {0, 0.5f, 1, 1, 3, endless};
    const QueryFilter filter{random.below(4) ? 3u : 1u, random.below(4) ? 3u : 2u};
    q.rays.push_back({ray.from, ray.displacement, reaches[random.below(6)], filter});
    const double sizes[] = {0, 0.1 * size, size, 1e5 * size};
    const auto extent = [&] { return float(sizes[random.below(random.below(10) ? 2 : 4)] * random.uniform(0, 1)); };
    q.boxes.push_back(
        {box.from, {extent(), extent(), extent()}, random.below(3) ? box.displacement : Vec3{0, 0, 0}, filter});
    q.poses.push_back({cast.from, random.orientation()});
    q.paths.push_back(random.below(10) ? cast.displacement : Vec3{0, 0, 0});
  }
  return q;
}

Shape dumbbell()
{
  std::vector<Child> children(2);
  children[0].shape = sphere_shape(0.4f);
  children[0].position = {0.5f, 0, 0};
  children[1].shape = box_shape(0.2f, 0.5f, 0.1f);
  children[1].position = {-0.5f, 0.1f, 0};
  return compound_shape(children);
}

/* Every kind of body; some large, some far away, some of one group only. */
Scene dense_cluster(int n, double size, Random &random)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < n; ++i) {
    const Point at = anywhere(random, {0, 0, 0}, random.below(12) ? size : 50 * size);
    if (random.below(15) == 0)
      add_body(scene, BodyType::fixed, any_height_field(random, 12, 0.5f), at).orientation = random.orientation();
    else if (random.below(15) == 0) add_body(scene, BodyType::fixed, dumbbell(), at);
    else if (random.below(12) == 0)
      add_body(scene, BodyType::fixed, random.below(2) ? box_shape(9, 0.2f, 14) : sphere_shape(8), at);
    else add_any(scene, random, at);
  }
  for (Body &body : scene.bodies) body.filter_group = 1u << random.below(2);
  return scene;
}

/* Equal small balls: where all cells are of their size. */
Scene balls_at(const std::vector<Point> &places)
{
  Scene scene = empty_scene();
  for (const Point &place : places) add_body(scene, BodyType::dynamic, sphere_shape(0.2f), place);
  return scene;
}

} // namespace

TEST_CASE("queries give the same bits by hierarchy, by grid and by brute force")
{
  for (uint64_t seed = 0; seed < 6; ++seed) {
    Random random(40 + seed);
    const double size = seed % 2 ? 4 : 20;
    const Scene scene = dense_cluster(seed < 4 ? 60 : 400, size, random);
    CAPTURE(seed);
    require_equal_answers(scene, questions_about(scene, random, 500, size), 300);
  }
}

TEST_CASE("queries agree in grids of one cell, of one row, and far from the origin")
{
  Random random(50);
  std::vector<Point> heap, row, far, single{{1, 2, 3}};
  for (int k = 0; k < 50; ++k) heap.push_back({1, 1, 1});
  for (int k = 0; k < 200; ++k) row.push_back({0, 0, 0.37 * k});
  for (int k = 0; k < 200; ++k) far.push_back(anywhere(random, {2e5, -3e5, 1e5}, 5));
  for (const std::vector<Point> &places : {heap, row, far, single}) {
    const Scene scene = balls_at(places);
    require_equal_answers(scene, questions_about(scene, random, 400, 3), 30);
  }
}

TEST_CASE("queries agree where all bodies are large, and where there is none but a half-space")
{
  Random random(51);
  Scene scene = empty_scene();
  add_ground(scene);
  require_equal_answers(scene, questions_about(scene, random, 100, 3), 10);
  for (int k = 0; k < 5; ++k) add_body(scene, BodyType::dynamic, sphere_shape(1), {3.0 * k, 1, 0}).continuous = true;
  require_equal_answers(scene, questions_about(scene, random, 300, 3), 30);
}
