/* catalog_test.cpp - built-in scenes: published positions, determinism, no overlap at the start, refusals. */
#include <bit>
#include <cmath>

#include <Eigen/Dense>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

using Vector = Eigen::Vector3d;

std::string complaint(const std::string &spec)
{
  try {
    load_scene(spec);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

Vector vector(const Vec3 &v) { return {v[0], v[1], v[2]}; }

/* How far two convex solids reach into each other along the axis: the smallest over the axes is the depth. */
struct BodyShape {
  ShapeType type;
  Vector centre, size;
  Eigen::Matrix3d axes;
  bool moves;

  double reach(const Vector &axis) const
  {
    return type == ShapeType::sphere ? size[0] : size.dot((axes.transpose() * axis).cwiseAbs());
  }
  double bounding_radius() const { return type == ShapeType::sphere ? size[0] : size.norm(); }
};

BodyShape body_shape(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  Eigen::Quaterniond q(body.orientation[3], body.orientation[0], body.orientation[1], body.orientation[2]);
  return {shape.type, Vector(body.position[0], body.position[1], body.position[2]), vector(shape.size),
          q.toRotationMatrix(), body.type == BodyType::dynamic};
}

std::vector<Vector> candidate_axes(const BodyShape &a, const BodyShape &b)
{
  std::vector<Vector> axes;
  if (a.type == ShapeType::sphere && b.type == ShapeType::sphere) return {b.centre - a.centre};
  for (const BodyShape *s : {&a, &b})
    if (s->type == ShapeType::box)
      for (int i = 0; i < 3; ++i) axes.push_back(s->axes.col(i));
  if (a.type == ShapeType::box && b.type == ShapeType::box) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) axes.push_back(a.axes.col(i).cross(b.axes.col(j)));
  } else { /* to the point of the box nearest to the sphere's centre */
    const BodyShape &box = a.type == ShapeType::box ? a : b, &ball = a.type == ShapeType::box ? b : a;
    Vector local = box.axes.transpose() * (ball.centre - box.centre);
    axes.push_back(box.axes * (local - local.cwiseMax(-box.size).cwiseMin(box.size)));
  }
  return axes;
}

double overlap(const BodyShape &a, const BodyShape &b)
{
  if (a.type == ShapeType::half_space || b.type == ShapeType::half_space) {
    const BodyShape &space = a.type == ShapeType::half_space ? a : b, &other = a.type == ShapeType::half_space ? b : a;
    Vector normal = space.axes.col(1);
    return other.reach(normal) - normal.dot(other.centre - space.centre);
  }
  Vector between = b.centre - a.centre;
  if (between.norm() > a.bounding_radius() + b.bounding_radius()) return -1;
  double least = 1e30;
  for (Vector axis : candidate_axes(a, b)) {
    if (axis.norm() < 1e-9) continue;
    axis.normalize();
    least = std::min(least, a.reach(axis) + b.reach(axis) - std::abs(axis.dot(between)));
  }
  return least;
}

double deepest_overlap(const Scene &scene)
{
  std::vector<BodyShape> body_shapes;
  for (const Body &body : scene.bodies) body_shapes.push_back(body_shape(scene, body));
  double deepest = -1e30;
  for (size_t i = 0; i < body_shapes.size(); ++i)
    for (size_t j = i + 1; j < body_shapes.size(); ++j)
      if (body_shapes[i].moves || body_shapes[j].moves)
        deepest = std::max(deepest, overlap(body_shapes[i], body_shapes[j]));
  return deepest;
}

uint64_t hash_of(const Scene &scene)
{
  uint64_t hash = 0xcbf29ce484222325u;
  auto mix = [&](float x) { hash = (hash ^ std::bit_cast<uint32_t>(x)) * 0x100000001b3u; };
  for (const Body &body : scene.bodies) {
    for (float x : body.position) mix(x);
    for (float x : body.orientation) mix(x);
    mix(body.mass);
  }
  return hash;
}

} // namespace

TEST_CASE("the overlap oracle knows boxes, balls and planes")
{
  BodyShape box{ShapeType::box, {0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), true}, other = box;
  other.centre = {1.9, 0, 0};
  CHECK(overlap(box, other) == Approx(0.1));
  other.centre = {1.9, 1, 2.2};
  CHECK(overlap(box, other) == Approx(-0.2));
  BodyShape ball{ShapeType::sphere, {1.5, 1.5, 0}, {0.5, 0.5, 0.5}, Eigen::Matrix3d::Identity(), true};
  CHECK(overlap(box, ball) == Approx(0.5 - std::sqrt(0.5)));
  BodyShape plane{ShapeType::half_space, {0, 0, 0}, {0, 0, 0}, Eigen::Matrix3d::Identity(), false};
  ball.centre = {7, 0.4, 7};
  CHECK(overlap(plane, ball) == Approx(0.1));
}

TEST_CASE("box-grid stands as published")
{
  const int nx = 5, ny = 4, nz = 3;
  Scene scene = load_scene("box-grid:nx=5,ny=4,nz=3");
  REQUIRE(scene.bodies.size() == size_t(1 + nx * ny * nz));
  const Body &ground = scene.bodies[0];
  CHECK(ground.type == BodyType::fixed);
  CHECK(scene.shapes[ground.shape].size == Vec3{400, 400, 400});
  CHECK(ground.position == Point{0, -400, 0});
  CHECK(scene.gravity == Vec3{0, -10, 0});
  size_t next = 1;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const Body &body = scene.bodies[next++];
        double shift = j % 2 == 0 ? 1 : 0; /* (j + 1) & 1 */
        CHECK(body.position[0] == Approx(shift + (i - 2) * 2.2));
        CHECK(body.position[1] == 1 + 2 * j);
        CHECK(body.position[2] == Approx(shift + (k - 1) * 2.2));
        CHECK(body.mass == 1);
        CHECK(body.type == BodyType::dynamic);
        CHECK(scene.shapes[body.shape].size == Vec3{1, 1, 1});
      }
  Material standard;
  CHECK(scene.materials[0].static_friction == standard.static_friction);
  CHECK(load_scene("box-grid").bodies.size() == 8001);
}

TEST_CASE("built-in scenes start without overlap, and touch nothing but what they stand on")
{
  for (const char *spec : {"box-grid:nx=4,ny=5,nz=4",
                           "falling-boxes:n=400",
                           "falling-boxes:n=60,half_extent=0.01,seed=9,height=0",
                           "box-stack:n=250",
                           "box-stack:n=47,height=6,gap=0,half_extent=2",
                           "pyramid:rows=12,gap=0",
                           "pyramid:rows=9",
                           "spheres:n=300,jitter=0.5,seed=3",
                           "mixed:n=400",
                           "mixed:n=300,seed=77",
                           "card-house:storeys=5",
                           "card-house:lean=0.8,thickness=0.1",
                           "arch",
                           "arch:courses=9,overhang=0.05",
                           "tower",
                           "dominoes",
                           "wall",
                           "wall:rows=3,length=4",
                           "tops:n=3",
                           "tops:lean=0",
                           "free-flight",
                           "incline",
                           "incline:slope=3,half_extent=2",
                           "bounce",
                           "mass-ratio"}) {
    INFO(spec);
    CHECK(deepest_overlap(load_scene(spec)) < 1e-5);
  }
  CHECK(deepest_overlap(load_scene("box-stack:n=20")) > -1e-5); /* stacked boxes do touch */
  CHECK(deepest_overlap(load_scene("pyramid:rows=3")) > -1e-5);
  for (const char *touching : {"card-house", "arch", "tower", "dominoes", "wall", "tops"}) {
    INFO(touching);
    CHECK(deepest_overlap(load_scene(touching)) > -1e-5);
  }
}

TEST_CASE("a seed decides a scene, to the bit, on every machine")
{
  CHECK(hash_of(load_scene("mixed:seed=5")) == hash_of(load_scene("mixed:seed=5")));
  CHECK(hash_of(load_scene("mixed:seed=5")) != hash_of(load_scene("mixed:seed=6")));
  CHECK(hash_of(load_scene("spheres:seed=5")) != hash_of(load_scene("spheres:seed=6")));
  CHECK(Random(0).next() == 0xe220a8397b1dcdafu); /* the published first value of SplitMix64 with state 0 */
  CHECK(hash_of(load_scene("falling-boxes:n=100")) == 0x4bb00b281da9ee20u);
  CHECK(hash_of(load_scene("mixed:n=100")) == 0x6cfe9f46e7ba39c7u);
}

TEST_CASE("random numbers keep to their range and fill it")
{
  Random random(42);
  int buckets[10] = {};
  double mean_w = 0;
  for (int i = 0; i < 10000; ++i) {
    double x = random.uniform(-2, 3);
    REQUIRE((x >= -2 && x < 3));
    uint32_t bucket = random.below(10);
    REQUIRE(bucket < 10);
    ++buckets[bucket];
    Quat q = random.orientation();
    mean_w += double(q[3]) * q[3];
  }
  for (int count : buckets) CHECK(std::abs(count - 1000) < 150); /* five standard deviations */
  CHECK(mean_w / 10000 == Approx(0.25).epsilon(0.05));
}

TEST_CASE("mixed uses every shape and material")
{
  Scene scene = load_scene("mixed:n=200");
  std::vector<int> shapes(scene.shapes.size()), materials(scene.materials.size());
  for (const Body &body : scene.bodies) ++shapes[body.shape], ++materials[body.material];
  for (int count : shapes) CHECK(count > 0);
  for (int count : materials) CHECK(count > 0);
}

TEST_CASE("parameters default, apply and show in the scene's name")
{
  SceneSpec spec = parse_scene_spec("spheres:n=7,restitution=0.5");
  CHECK(spec.values.at("n") == 7);
  CHECK(spec.values.at("radius") == 0.5);
  Scene scene = build_scene(spec);
  CHECK(scene.bodies.size() == 8);
  CHECK(scene.materials[0].restitution == 0.5f);
  CHECK(scene.name == "spheres:n=7,radius=0.5,restitution=0.5,jitter=0.1,height=1,seed=1");
  CHECK(hash_of(load_scene(scene.name)) == hash_of(scene));
  for (const BuiltInScene &row : built_in_scenes())
    for (const SceneParameter &p : row.parameters) {
      INFO(row.name << " " << p.name);
      CHECK((p.minimum <= p.default_value && p.default_value <= p.maximum));
      CHECK(std::string(p.description).size() > 0);
    }
}

TEST_CASE("bad specifications are refused with what exists")
{
  CHECK_THAT(complaint("box-gird"),
             ContainsSubstring("unknown scene 'box-gird'") &&
                 ContainsSubstring("box-grid, falling-boxes, box-stack, pyramid, spheres, mixed"));
  CHECK_THAT(complaint("pile.usd"), ContainsSubstring(".json, .gltf, .glb, .urdf or .xml"));
  CHECK_THAT(complaint(""), ContainsSubstring("unknown scene ''"));
  CHECK_THAT(complaint("box-grid:mx=3"), ContainsSubstring("unknown parameter 'mx'; parameters: nx, ny, nz"));
  CHECK_THAT(complaint("box-grid:nx=0"), ContainsSubstring("nx=0 is out of range; 1 to 360"));
  CHECK_THAT(complaint("box-grid:nx=-5"), ContainsSubstring("out of range"));
  CHECK_THAT(complaint("spheres:n=1e300"), ContainsSubstring("out of range"));
  CHECK_THAT(complaint("spheres:n=1e999"), ContainsSubstring("out of range"));
  CHECK_THAT(complaint("box-grid:nx=2.5"), ContainsSubstring("an integer is needed"));
  CHECK_THAT(complaint("box-grid:nx=two"), ContainsSubstring("an integer is needed"));
  CHECK_THAT(complaint("box-grid:nx="), ContainsSubstring("an integer is needed"));
  CHECK_THAT(complaint("spheres:radius=0.5m"), ContainsSubstring("a number is needed"));
  CHECK_THAT(complaint("spheres:radius=nan"), ContainsSubstring("a number is needed"));
  CHECK_THAT(complaint("box-grid:nx"), ContainsSubstring("'nx' is not key=value"));
  CHECK_THAT(complaint("box-grid:=3"), ContainsSubstring("is not key=value"));
  CHECK_THAT(complaint("box-grid:nx=3,"), ContainsSubstring("'' is not key=value"));
  CHECK_THAT(complaint("box-grid:nx=3,nx=4"), ContainsSubstring("given twice"));
  CHECK_THAT(complaint("box-grid:nx=360,ny=10000,nz=360"), ContainsSubstring("1296000001 bodies; at most 64000000"));
  CHECK_THAT(complaint("newton-cradle:n=3,raised=3"),
             ContainsSubstring("raised=3 of n=3 balls; fewer than n are possible"));
  CHECK_THAT(complaint("four-bar:crank=0.6"), ContainsSubstring("the crank cannot turn; it must be the shortest"));
  CHECK_THAT(complaint("four-bar:coupler=2"), ContainsSubstring("crank=0.2, coupler=2, rocker=0.5, ground=0.6"));
  CHECK_THAT(complaint("vehicle:steering=1"), ContainsSubstring("steering=1 is out of range; -0.5 to 0.5"));
  CHECK_NOTHROW(check_bodies("spheres", 10, 20 * sizeof(Body)));
  CHECK_THROWS_WITH(check_bodies("spheres", 11, 20 * sizeof(Body)), ContainsSubstring("at most 10 are possible"));
  CHECK_THAT(complaint("missing/scene.json"), ContainsSubstring("missing/scene.json: cannot read: No such file"));
  CHECK_THAT(complaint("missing/scene.gltf"), ContainsSubstring("cannot read"));
}
