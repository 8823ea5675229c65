/* Triangle meshes as ground and as bodies: internal edges cause no contact, valleys and ridges do. */
#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A strip along x with the profile y(x) given by points, between z = -4 and 4, each slab of two triangles. */
Shape profile_mesh(const std::vector<std::array<double, 2>> &profile)
{
  std::vector<Vec3> vertices;
  std::vector<uint32_t> indices;
  for (const auto &[x, y] : profile)
    for (float z : {-4.0f, 4.0f}) vertices.push_back({float(x), float(y), z});
  for (uint32_t i = 0; i + 3 < vertices.size(); i += 2)
    indices.insert(indices.end(), {i, i + 1, i + 2, i + 2, i + 1, i + 3});
  return mesh_shape(vertices, indices, "profile");
}

Body &add_mesh(Scene &scene, const Shape &shape, const Vector &at = Vector::Zero(), const Quat &turn = {0, 0, 0, 1})
{
  Body &body = add_body(scene, BodyType::fixed, shape, point_of(at));
  body.orientation = turn;
  return body;
}

void make_slippery(Scene &scene) { scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0; }

} // namespace

TEST_CASE("nothing catches on the seams of a flat mesh", "[physics]")
{
  const int speed = GENERATE(5, 30, 100);
  World world(load_scene(fmt::format("mesh-slide:speed={}", speed)));
  run(world, 30); /* the hull and the table have come down */
  const std::vector<BodyState> start = world.bodies();
  run(world, 90);
  const std::vector<BodyState> end = world.bodies();
  for (size_t i = 1; i < end.size(); ++i) {
    CAPTURE(speed, i);
    CHECK(std::abs(end[i].linear_velocity[0] - float(speed)) < 2e-3);
    CHECK(std::abs(end[i].linear_velocity[2]) < 1e-3);
    const bool tumbles = i == 6 || i == 5; /* the hull, and a capsule that lies on two triangles at most */
    CHECK(std::abs(end[i].position[1] - start[i].position[1]) < (tumbles ? 0.1 : 1e-3));
  }
}

/* Three seconds on a mesh are three seconds on a plane. */
TEST_CASE("a ball rolls on a flat mesh as on a plane", "[physics]")
{
  Scene on_mesh = load_scene("mesh-slide:friction=0.6"), on_plane = empty_scene();
  on_mesh.bodies.resize(2);
  on_plane.materials = on_mesh.materials;
  add_ground(on_plane);
  Body ball = on_mesh.bodies[1];
  on_plane.shapes.push_back(on_mesh.shapes[ball.shape]);
  ball.shape = uint32_t(on_plane.shapes.size() - 1);
  on_plane.bodies.push_back(ball);
  World mesh(on_mesh), plane(on_plane);
  run(mesh, 180);
  run(plane, 180);
  const BodyState a = mesh.bodies()[1], b = plane.bodies()[1];
  CHECK((vector_of(a.position) - vector_of(b.position)).norm() < 2e-3);
  CHECK((vector_of(a.linear_velocity) - vector_of(b.linear_velocity)).norm() < 1e-3);
  CHECK((vector_of(a.angular_velocity) - vector_of(b.angular_velocity)).norm() < 5e-3);
}

/* The centre rests r / cos(slope) above the bottom of the valley, less the slop that both sides give way. */
TEST_CASE("a ball rests in a valley on both its sides", "[physics]")
{
  const double slope = GENERATE(15.0, 45.0, 70.0) * radians, radius = 0.4;
  Scene scene = empty_scene();
  make_slippery(scene);
  add_mesh(scene, profile_mesh({{-2, 2 * std::tan(slope)}, {0, 0}, {2, 2 * std::tan(slope)}}));
  add_dynamic_body(scene, sphere_shape(float(radius)), {0.01, radius / std::cos(slope) + 0.02, 0});
  Settings settings;
  World world(scene, settings);
  run(world, 600);
  const BodyState ball = world.bodies()[1];
  const double sunk = radius / std::cos(slope) - ball.position[1];
  CAPTURE(slope, sunk, ball.position[0]);
  CHECK(std::abs(ball.position[0]) < 0.006 / std::sin(slope));
  CHECK(sunk > -1e-3);
  CHECK(sunk < 0.006 / std::cos(slope));
  CHECK(world.statistics().manifolds == 2);
}

/* Down a plane of many slabs at the acceleration of one. */
TEST_CASE("a box slides down an inclined mesh as down a plane", "[physics]")
{
  const double slope = 20 * radians, seconds = 1;
  std::vector<std::array<double, 2>> profile;
  for (int k = 0; k <= 60; ++k) profile.push_back({k * 0.31 - 2, -(k * 0.31 - 2) * std::tan(slope)});
  Scene scene = empty_scene();
  make_slippery(scene);
  add_mesh(scene, profile_mesh(profile));
  const Vector down(std::cos(slope), -std::sin(slope), 0), up(std::sin(slope), std::cos(slope), 0);
  add_dynamic_body(scene, box_shape(0.4f, 0.2f, 0.3f), 0.2 * up, turn_about({0, 0, 1}, -slope));
  World world(scene);
  run(world, int(60 * seconds));
  const Vector v = vector_of(world.bodies()[1].linear_velocity);
  CHECK(v.dot(down) == Approx(gravity * std::sin(slope) * seconds).epsilon(1e-3));
  CHECK(std::abs(v.dot(up)) < 1e-3);
}

TEST_CASE("a box that slides against the foot of a wall of the same mesh stops there", "[physics]")
{
  Scene scene = empty_scene();
  make_slippery(scene);
  add_mesh(scene, profile_mesh({{-3, 0}, {-1, 0}, {0, 0}, {1, 0}, {1, 2}}));
  add_dynamic_body(scene, box_shape(0.3f, 0.3f, 0.3f), {-1, 0.3, 0}).linear_velocity = {4, 0, 0};
  World world(scene);
  run(world, 120);
  const BodyState box = world.bodies()[1];
  CHECK(std::abs(box.linear_velocity[0]) < 0.05);
  CHECK(box.position[0] < 0.71);
  CHECK(std::abs(box.position[1] - 0.3) < 0.01);
}

/* A surface has one solid side. */
TEST_CASE("what comes from behind passes a mesh, what comes from before does not", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_mesh(scene, profile_mesh({{-3, 0}, {0, 0}, {3, 0}}));
  const Shape shapes[] = {sphere_shape(0.2f), box_shape(0.2f, 0.2f, 0.2f), capsule_shape(0.1f, 0.1f),
                          hull_of_box(0.2f, 0.2f, 0.2f)};
  for (int k = 0; k < 4; ++k) {
    add_dynamic_body(scene, shapes[k], {k - 1.5, -1, 1}).linear_velocity = {0, 3, 0};
    add_dynamic_body(scene, shapes[k], {k - 1.5, 1, -1}).linear_velocity = {0, -3, 0};
  }
  World world(scene);
  run(world, 60);
  const std::vector<BodyState> states = world.bodies();
  for (size_t i = 1; i < states.size(); ++i) {
    CAPTURE(i);
    CHECK(states[i].position[1] > 0);
    if (i % 2) CHECK(states[i].linear_velocity[1] == 3);
  }
}

TEST_CASE("a closed mesh falls, rests and turns as the box it is", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_dynamic_body(scene, mesh_of_box(0.3f, 0.2f, 0.4f), {0, 0.3, 0});
  add_dynamic_body(scene, mesh_of_box(0.3f, 0.2f, 0.4f), {3, 0.3, 0}, turn_about({1, 2, 3}, 0.7));
  add_dynamic_body(scene, box_shape(0.5f, 0.5f, 0.5f), {6, 0.5, 0});
  add_dynamic_body(scene, mesh_of_box(0.3f, 0.2f, 0.4f), {6, 1.25, 0});
  add_dynamic_body(scene, mesh_of_box(0.5f, 0.5f, 0.5f), {9, 0.5, 0});
  add_dynamic_body(scene, mesh_of_box(0.3f, 0.2f, 0.4f), {9.03, 1.25, 0.02}, turn_about({0, 1, 0}, 0.3));
  const Vec3 moments = inertia_of(scene.shapes[scene.bodies[1].shape], 1),
             expected = inertia_of(box_shape(0.3f, 0.2f, 0.4f), 1);
  for (size_t k = 0; k < 3; ++k) CHECK(moments[k] == Approx(expected[k]).epsilon(1e-6));
  World world(scene);
  run(world, 400);
  const std::vector<BodyState> states = world.bodies();
  for (const auto &[body, height] : {std::pair{1, 0.2}, {3, 0.5}, {4, 1.2}, {5, 0.5}, {6, 1.2}}) {
    CAPTURE(body);
    CHECK(std::abs(states[size_t(body)].position[1] - height) < 0.012);
    CHECK(vector_of(states[size_t(body)].linear_velocity).norm() < 0.01);
  }
  const double heights[] = {0.2, 0.3, 0.4}; /* the thrown one lies on some side */
  CHECK(std::any_of(std::begin(heights), std::end(heights),
                    [&](double height) { return std::abs(states[2].position[1] - height) < 0.01; }));
  CHECK(world.statistics().max_penetration < 0.008);
}

TEST_CASE("closed meshes collide in free space and keep their momentum", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  Random random(5);
  for (int k = 0; k < 12; ++k) {
    Body &body = add_dynamic_body(scene, mesh_of_box(0.3f, 0.2f, 0.4f),
                                  {random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9)},
                                  random.orientation());
    body.linear_velocity = vec3_of(-2 * vector_of(body.position));
  }
  World world(scene);
  const Momentum before = momentum_of(world);
  uint32_t contacts = 0;
  for (int i = 0; i < 60; ++i) {
    world.step();
    contacts += world.statistics().contacts;
  }
  const Momentum after = momentum_of(world);
  CHECK(contacts > 100);
  CHECK((after.linear - before.linear).norm() < 1e-5 * before.linear_scale);
  CHECK((after.angular - before.angular).norm() < 1e-4 * before.linear_scale);
}

TEST_CASE("a field of heights is where its heights say", "[physics]")
{
  const auto height = [](double x, double z) { return 0.3 * x - 0.2 * z; };
  std::vector<float> heights;
  for (int z = 0; z < 9; ++z)
    for (int x = 0; x < 13; ++x) heights.push_back(float(height(0.5 * (x - 6), 0.25 * (z - 4))));
  Scene scene = empty_scene();
  scene.materials[0].static_friction = 2;
  scene.materials[0].dynamic_friction = 2;
  add_mesh(scene, height_field_shape(heights, 13, 0.5f, 0.25f, "field"));
  const Vector up = Vector(-0.3, 1, 0.2).normalized();
  add_dynamic_body(scene, box_shape(0.3f, 0.1f, 0.2f), Vector(1, height(1, -0.3), -0.3) + 0.11 * up, turn_of_y_to(up));
  World world(scene);
  run(world, 120);
  const Vector at = vector_of(world.bodies()[1].position);
  CHECK(std::abs((at - Vector(0, height(0, 0), 0)).dot(up) - 0.1) < 0.006);
  CHECK(vector_of(world.bodies()[1].linear_velocity).norm() < 0.01);
}
