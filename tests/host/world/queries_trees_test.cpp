/* Rays and shape casts against meshes and compounds. The oracle tests every triangle and child one by one in double
 * precision. */
#include "host/geometry/triangle_mesh.h"
#include "host/world/queries.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Shape wide_hills(Random &random)
{
  std::vector<float> heights;
  for (int i = 0; i < 24 * 20; ++i) heights.push_back(float(random.uniform(-0.3, 0.3)));
  return height_field_shape(heights, 24, 0.3f, 0.35f, "hills");
}

Child child_of(const Shape &shape, Random &random)
{
  Child child;
  child.shape = shape;
  child.position = vec3_of(Vector(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)));
  child.orientation = random.orientation();
  return child;
}

/* A mesh, a compound with a mesh in it, and compounds of balls and boxes, all fixed. */
Scene meadow()
{
  Random random(12);
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, wide_hills(random), {1, -2, 0.5}).orientation = random.orientation();
  add_body(scene, BodyType::fixed,
           compound_shape({child_of(wide_hills(random), random), child_of(sphere_shape(0.4f), random)}), {0, 2, 0})
      .orientation = random.orientation();
  for (int k = 0; k < 8; ++k)
    add_body(scene, BodyType::fixed,
             compound_shape({child_of(sphere_shape(0.3f), random), child_of(box_shape(0.3f, 0.1f, 0.4f), random),
                             child_of(box_shape(0.1f, 0.2f, 0.1f), random)}),
             {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)})
        .orientation = random.orientation();
  return scene;
}

constexpr double never = 1e300;

double hit_triangle(const Vector &o, const Vector &u, const Vector &a, const Vector &b, const Vector &c)
{
  const Vector normal = (b - a).cross(c - a);
  const double rise = normal.dot(u), s = normal.dot(a - o) / rise;
  const Vector p = o + s * u;
  const bool inside = normal.dot((b - a).cross(p - a)) >= 0 && normal.dot((c - b).cross(p - b)) >= 0 &&
                      normal.dot((a - c).cross(p - c)) >= 0;
  return rise != 0 && s >= 0 && inside ? s : never;
}
/* The hits of a ray from outside. */
double hit_sphere(const Vector &o, const Vector &u, double radius)
{
  const double along = o.dot(u), square = along * along - o.squaredNorm() + radius * radius;
  return square >= 0 && -along - std::sqrt(square) >= 0 ? -along - std::sqrt(square) : never;
}
double hit_box(const Vector &o, const Vector &u, const Vector &half)
{
  double enter = 0, leave = never;
  for (int k = 0; k < 3; ++k) {
    const double first = (-half[k] - o[k]) / u[k], second = (half[k] - o[k]) / u[k];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter <= leave ? enter : never;
}

/* In the shape's own frame. */
double hit_shape(const Vector &o, const Vector &u, const Shape &shape)
{
  if (shape.type == ShapeType::sphere) return hit_sphere(o, u, shape.size[0]);
  if (shape.type == ShapeType::box) return hit_box(o, u, vector_of(shape.size));
  double first = never;
  if (shape.mesh)
    for (const auto &[i, j, k] : shape.mesh->triangles)
      first = std::min(first, hit_triangle(o, u, vector_of(shape.mesh->vertices[i]), vector_of(shape.mesh->vertices[j]),
                                           vector_of(shape.mesh->vertices[k])));
  else
    for (const Child &child : shape.compound->children) {
      const Matrix back = axes_of(child.orientation).transpose();
      first = std::min(first, hit_shape(back * (o - vector_of(child.position)), back * u, child.shape));
    }
  return first;
}

} // namespace

TEST_CASE("rays against meshes and compounds hit what is nearest of all their parts")
{
  const Scene scene = meadow();
  World world(scene);
  Random random(3);
  std::vector<Ray> rays;
  for (int k = 0; k < 4000; ++k) {
    const Vector from = 12 * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const Vector to(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4));
    Ray ray;
    ray.origin = point_of(from);
    ray.direction = vec3_of(to - from);
    rays.push_back(ray);
  }
  const std::vector<RayHit> hits = world.cast_rays(rays);
  size_t found = 0, apart = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    const Vector o = vector_of(rays[k].origin), displacement = vector_of(rays[k].direction),
                 u = displacement.normalized();
    double nearest = never;
    uint32_t body = no_body;
    for (uint32_t b = 0; b < scene.bodies.size(); ++b) {
      const Matrix back = axes_of(scene.bodies[b].orientation).transpose();
      const double s =
          hit_shape(back * (o - vector_of(scene.bodies[b].position)), back * u, scene.shapes[scene.bodies[b].shape]);
      if (s < nearest) nearest = s, body = b;
    }
    const bool hit = nearest <= displacement.norm();
    found += hit;
    const bool same =
        hit == (hits[k].body != no_body) &&
        (!hit || (hits[k].body == body && std::abs(hits[k].fraction * displacement.norm() - nearest) < 1e-4));
    apart += !same;
  }
  CHECK(found > 1000);
  CHECK(apart <= 4); /* those that graze an edge, one in a thousand */
}

TEST_CASE("shape casts come down on meshes and children as far as closed forms say")
{
  Scene scene = empty_scene();
  std::vector<float> heights(9 * 9);
  for (int i = 0; i < 81; ++i) heights[size_t(i)] = float(0.25 * (i % 9)); /* y = 0.5 x + 1 */
  add_body(scene, BodyType::fixed, height_field_shape(heights, 9, 0.5f, 0.5f, "slope"), {0, 0, 0});
  Child child;
  child.shape = box_shape(0.5f, 0.5f, 0.5f);
  child.position = {0, 3, 0};
  Child other;
  other.shape = sphere_shape(0.1f);
  add_body(scene, BodyType::fixed, compound_shape({child, other}), {10, 0, 0});
  World world(scene);
  const std::vector<Pose> poses{
      {{0.3, 5, 0.2}, {0, 0, 0, 1}}, {{10.2, 6, 0.1}, {0, 0, 0, 1}}, {{30, 6, 0}, {0, 0, 0, 1}}};
  const std::vector<Vec3> paths(3, Vec3{0, -10, 0});
  const std::vector<ShapeCastHit> hits = world.cast_shapes(sphere_shape(0.2f), poses, paths);
  REQUIRE((hits[0].body != no_body && hits[1].body != no_body && hits[2].body == no_body));
  const double slope_height = 0.5 * 0.3 + 1,
               over_slope = 0.2 * std::hypot(1, 0.5); /* of the centre that touches, above the surface below it */
  CHECK(hits[0].body == 0);
  CHECK(10 * hits[0].fraction == Approx(5 - slope_height - over_slope).margin(1e-4));
  CHECK(vector_of(hits[0].normal).dot(Vector(-0.5, 1, 0).normalized()) == Approx(1).margin(1e-4));
  CHECK(hits[1].body == 1);
  CHECK(10 * hits[1].fraction == Approx(6 - 3.5 - 0.2).margin(1e-4));
}

TEST_CASE("a fast body with continuous collision does not pass a sheet that is a mesh", "[physics]")
{
  const float speed = GENERATE(50.0f, 1000.0f, 10000.0f);
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::fixed, height_field_shape(std::vector<float>(21 * 21, 0.0f), 21, 100, 100, "sheet"),
           {0, 0, 0}); /* spin sends them far aside */
  const Shape shapes[] = {sphere_shape(0.1f), box_shape(0.1f, 0.05f, 0.1f), capsule_shape(0.05f, 0.1f),
                          hull_of_box(0.1f, 0.1f, 0.05f)};
  for (int k = 0; k < 4; ++k) {
    Body &body = add_dynamic_body(scene, shapes[k], {k - 1.5, 3, 0.1 * k}, turn_about({1, 1, 0}, 0.3 * k));
    body.linear_velocity = {0.5f, -speed, 0};
    body.continuous = true;
    body.filter_group = 2;
    body.filter_mask = 1;
  }
  World world(scene);
  for (int i = 0; i < 20; ++i) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t k = 1; k < states.size(); ++k) {
      CAPTURE(speed, k, i);
      CHECK(states[k].position[1] > 0);
    }
  }
}
